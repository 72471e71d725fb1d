#include "tests/service/service_fixture.h"

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <stdlib.h>

#include "client/event_stream.h"

namespace afterglow::test {

namespace {

const std::string bin = AFTERGLOW_BIN_DIR "/";

}  // namespace

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "afterglow-e2e-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string data_file(const std::string& name) {
    return std::string(AFTERGLOW_TEST_DATA) + "/" + name;
}

std::vector<client::Json> json_lines(const std::string& text) {
    std::vector<client::Json> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(client::Json::parse(line));
    return lines;
}

void ServiceTest::SetUp() {
    start_server();
}

void ServiceTest::start_server() {
    server_ = std::make_unique<Process>(std::vector<std::string>{bin + "afterglowd", "serve", "--listen",
                                                                 "127.0.0.1:0", "--data",
                                                                 (folder_.path() / "data").string()});
    const std::string sign = "listening on ";
    const auto ready = [&](const std::string& out) {
        const auto at = out.find(sign);
        return at != std::string::npos && out.find('\n', at) != std::string::npos;
    };
    ASSERT_TRUE(server_->wait_for_output(ready)) << server_->err();
    const std::string out = server_->out();
    const auto begin = out.find(sign) + sign.size();
    url_ = out.substr(begin, out.find('\n', begin) - begin);
    http_ = std::make_unique<client::HttpConnection>(url_, interrupt_);
}

std::unique_ptr<Process> ServiceTest::start_afterglow(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{bin + "afterglow"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return std::make_unique<Process>(all, std::vector<std::string>{"AFTERGLOW_SERVER=" + url_});
}

Outcome ServiceTest::afterglow(const std::vector<std::string>& arguments) {
    const auto process = start_afterglow(arguments);
    const auto exit = process->wait();
    EXPECT_TRUE(exit.has_value()) << arguments[0] << " did not end";
    return {exit.value_or(-1), process->out(), process->err()};
}

std::string ServiceTest::submit(const std::string& scene, const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"submit", "--json", data_file(scene)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = afterglow(arguments);
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    return client::Json::parse(outcome.out).at("id").get<std::string>();
}

std::string ServiceTest::upload(const std::string& scene) {
    std::ifstream in(data_file(scene), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    return client::Json::parse(http_->post("/v1/scenes", bytes, "model/gltf-binary").body).at("id");
}

std::string ServiceTest::submit_quickly(const std::string& scene, const std::string& settings) {
    return submit_quickly(scene, settings, *http_);
}

std::string ServiceTest::submit_quickly(const std::string& scene, const std::string& settings,
                                        client::HttpConnection& http) {
    const std::string body = R"({"scene":")" + scene + R"(","settings":)" + settings + "}";
    const auto reply = http.post("/v1/jobs", body, "application/json");
    if (reply.status != 201) throw std::runtime_error(reply.body);
    return client::Json::parse(reply.body).at("id");
}

client::Json ServiceTest::job(const std::string& id) {
    const Outcome outcome = afterglow({"show", id, "--json"});
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    return client::Json::parse(outcome.out);
}

std::vector<client::Json> ServiceTest::all_events(const std::string& id) {
    client::EventStreamParser parser;
    std::vector<client::Json> events;
    const auto sink = [&](std::string_view bytes) {
        for (const auto& event : parser.feed(bytes))
            events.push_back({{"event", event.name},
                              {"id", std::stoi(event.id)},
                              {"data", client::Json::parse(event.data)}});
        return client::StreamNext::more;
    };
    const auto reply = http_->stream("/v1/jobs/" + id + "/events", {{"Last-Event-ID", "0"}}, sink);
    EXPECT_EQ(reply.status, 200) << reply.body;
    return events;
}

std::map<int, std::string> ServiceTest::finished(const std::string& id) {
    std::map<int, std::string> pictures;
    const auto reply = client::Json::parse(http_->get("/v1/jobs/" + id + "/frames").body);
    for (const auto& frame : reply.at("frames"))
        if (frame.at("final") == true)
            pictures[frame.at("frame")] = http_->get(frame.at("exr").get<std::string>()).body;
    return pictures;
}

std::vector<std::string> ServiceTest::small(const std::string& frames) {
    return {"--frames", frames, "--size", "48x48", "--rays", "32", "--quality", "draft"};
}

std::vector<std::string> ServiceTest::endless() {
    return {"--fps", "1000", "--size", "128x128", "--rays", "64", "--quality", "preview"};
}

}  // namespace afterglow::test
