// Any bytes sent to the whole service end in a reply that is HTTP, and no failure of its own: heads, chunks,
// forms, lists of files, queries, ids of events, entity tags and merge patches by every route. ID stands for
// an ended job.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>

#include "service/api/service.h"
#include "service/http/gate.h"
#include "service/http/http_server.h"
#include "solver/base/pixels.h"
#include "tests/unit/service/fake_solver.h"
#include "tests/unit/service/peer.h"

namespace {

using namespace afterglow;

/// Nothing but the seeds' own scene, or uploads would fill the disk.
Scene seed_scene(std::string_view bytes, const SceneUpload& upload) {
    if (bytes != "bytes") throw Error(ErrorKind::invalid_input, upload.name, "is no scene");
    return fake_scene(bytes, upload);
}

GateConfig gate_config() {
    GateConfig config;
    config.hosts = {"x"};
    return config;
}

HttpServerConfig server_config() {
    HttpServerConfig config;
    config.max_body_bytes = 100'000;
    config.patience.linger = std::chrono::milliseconds(50);
    config.gate = make_gate(gate_config());
    return config;
}

class Target {
  public:
    std::string ended_job() {
        if (job_.empty() || ask("GET", "/v1/jobs/" + job_, "").status != 200) job_ = make_job();
        return job_;
    }
    [[nodiscard]] int port() const { return port_; }

  private:
    Reply ask(const std::string& method, const std::string& path, const std::string& body,
              const std::string& type = "application/json") {
        Reply reply =
            service_.router().handle({method, path, {{"wait", "60"}}, {{"content-type", type}}, body});
        // A job that is waited for is told when it has ended.
        while (reply.stream && reply.stream->next().then != Piece::Then::end) continue;
        return reply;
    }
    std::string make_job() {
        const Reply scene = service_.router().handle(
            {"POST", "/v1/scenes", {}, {{"content-type", "model/gltf-binary"}}, "bytes"});
        const std::string request = R"({"settings":{"frames":"0-1"},"scene":)" +
                                    parse_json(scene.body, "scene").at("id").dump() + "}";
        const std::string id =
            parse_json(ask("POST", "/v1/jobs", request).body, "job").at("id").get<std::string>();
        ask("GET", "/v1/jobs/" + id, "");
        return id;
    }

    /// What is used first goes last at the exit: the EXR library's threads outlast the service's encoder.
    std::string first_picture_ = encode_exr(Picture(1, 1));
    ScratchFolder folder_;
    FakeSolver solver_;
    Service service_{{folder_.path(), 1, 4, {}}, {seed_scene, solver_.factory()}};
    HttpServer server_{service_.router(), server_config()};
    int port_ = server_.start();
    std::string job_;
};

std::string with_job(std::string text, const std::string& job) {
    for (auto at = text.find("/ID"); at != std::string::npos; at = text.find("/ID", at + 1))
        text.replace(at + 1, 2, job);
    return text;
}

std::size_t threads_now() {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator("/proc/self/task"), {}));
}

std::string reply_to(Target& target, const std::string& request) {
    const Peer peer(target.port());
    if (!peer.send(request)) return "";
    peer.end_sending();
    return peer.receive_all();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // Lives as long as the process, as its threads do.
    static Target target;
    const std::string request = with_job({reinterpret_cast<const char*>(data), size}, target.ended_job());
    static const std::size_t threads_at_rest = threads_now();
    const std::string reply = reply_to(target, request);
    // What a connection's thread still holds is not to be taken for a leak.
    while (threads_now() > threads_at_rest) std::this_thread::sleep_for(std::chrono::microseconds(100));
    if (reply.empty()) return 0;  // a request that breaks off
    if (!reply.starts_with("HTTP/1.1 ")) std::abort();
    if (reply.starts_with("HTTP/1.1 500")) std::abort();
    return 0;
}
