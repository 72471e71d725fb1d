#include <algorithm>
#include <arpa/inet.h>
#include <csignal>
#include <fstream>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/service/service_fixture.h"

namespace afterglow::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class BadInput : public ServiceTest {
  protected:
    std::string write(const std::string& name, const std::string& content) {
        const auto path = folder_.path() / name;
        std::ofstream(path, std::ios::binary) << content;
        return path.string();
    }
    /// One line on standard error that names the place, exit status 2, nothing on standard output, no job.
    void expect_refused(const std::vector<std::string>& arguments, const std::string& place) {
        const Outcome outcome = afterglow(arguments);
        EXPECT_EQ(outcome.exit, 2) << outcome.err;
        EXPECT_EQ(outcome.out, "");
        EXPECT_THAT(outcome.err, StartsWith("afterglow: "));
        EXPECT_THAT(outcome.err, HasSubstr(place));
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_EQ(client::Json::parse(http_->get("/v1/jobs").body).at("jobs").size(), 0U);
    }
};

TEST_F(BadInput, AFileThatIsNoSceneIsRefusedByName) {
    expect_refused({"submit", write("noise.glb", "this is no model")}, "noise.glb");
    expect_refused({"submit", write("broken.json", "{\"nodes\": [")}, "broken.json");
}

TEST_F(BadInput, ASceneThatIsCutOffIsRefusedByName) {
    std::ifstream in(data_file("cornell-slide.glb"), std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), {}};
    ASSERT_GT(whole.size(), 1000U);
    expect_refused({"submit", write("short.glb", whole.substr(0, 1000))}, "short.glb");
}

TEST_F(BadInput, AMissingFileIsNamed) {
    expect_refused({"submit", "/nowhere/scene.glb"}, "/nowhere/scene.glb: no such file");
    expect_refused({"submit", data_file("cornell-slide.glb"), "--paths", "/nowhere/p.json"},
                   "/nowhere/p.json");
}

TEST_F(BadInput, ASettingThatMakesNoSenseIsNamed) {
    const std::string scene = data_file("cornell-slide.glb");
    expect_refused({"submit", scene, "--frames", "5-2"}, "frames");
    expect_refused({"submit", scene, "--method", "magic"}, "magic");
    expect_refused({"submit", scene, "--rays", "1"}, "rays");
    expect_refused({"submit", scene, "--size", "0x0"}, "--size");
}

TEST_F(BadInput, PathsThatAreNoPathsAreRefused) {
    expect_refused({"submit", data_file("cornell-slide.glb"), "--paths",
                    write("p.json", R"({"afterglow_paths": 1, "tracks": 3})")},
                   "tracks");
}

TEST(NoService, IsReportedAtOnce) {
    Process ls({AFTERGLOW_BIN_DIR "/afterglow", "ls", "--server", "http://127.0.0.1:1"});
    EXPECT_EQ(ls.wait(), 5);
    EXPECT_EQ(ls.err(), "afterglow: http://127.0.0.1:1: cannot be reached\n");
    Process watch({AFTERGLOW_BIN_DIR "/afterglow", "watch", "x", "--server", "http://127.0.0.1:1"});
    EXPECT_EQ(watch.wait(), 5);
}

/// A server that accepts connections and never answers.
class SilentServer {
  public:
    SilentServer() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        auto* raw = reinterpret_cast<sockaddr*>(&address);
        if (::bind(socket_, raw, size) != 0 || ::listen(socket_, 4) != 0)
            throw std::runtime_error("no socket");
        ::getsockname(socket_, raw, &size);
        port_ = ntohs(address.sin_port);
    }
    ~SilentServer() { ::close(socket_); }
    SilentServer(const SilentServer&) = delete;
    SilentServer& operator=(const SilentServer&) = delete;
    [[nodiscard]] std::string url() const { return "http://127.0.0.1:" + std::to_string(port_); }
    /// Waits for a client and for the first byte of its request.
    void meet_client() const {
        const int connection = ::accept(socket_, nullptr, nullptr);
        char byte = 0;
        ASSERT_EQ(::recv(connection, &byte, 1, 0), 1);
        // Left open: the client must not be freed by us.
    }

  private:
    int socket_;
    int port_ = 0;
};

TEST(NoService, CtrlCEndsASubmitThatHangs) {
    const SilentServer server;
    Process submit(
        {AFTERGLOW_BIN_DIR "/afterglow", "submit", data_file("living-room.glb"), "--server", server.url()});
    server.meet_client();
    submit.send_signal(SIGINT);
    EXPECT_EQ(submit.wait(), 130);
    EXPECT_EQ(submit.err(), "afterglow: interrupted\n");
    EXPECT_EQ(submit.out(), "");
}

}  // namespace
}  // namespace afterglow::test
