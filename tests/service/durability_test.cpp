#include <csignal>
#include <fstream>
#include <random>
#include <set>
#include <thread>

#include "tests/service/service_fixture.h"

namespace afterglow::test {
namespace {

/// Kills the server at random moments while jobs are submitted and run, and looks at what it still knows.
class Durability : public ServiceTest {
  protected:
    void kill_and_restart() {
        server_->send_signal(SIGKILL);
        server_->wait();
        start_server();
    }
    std::set<std::string> known() {
        std::set<std::string> ids;
        const auto reply = client::Json::parse(http_->get("/v1/jobs").body);
        for (const auto& job : reply.at("jobs")) ids.insert(job.at("id").get<std::string>());
        return ids;
    }
};

TEST_F(Durability, NothingAcknowledgedIsLostWhenTheServerIsKilled) {
    std::mt19937 random(1);
    std::set<std::string> acknowledged;
    for (int round = 0; round < 6; ++round) {
        acknowledged.insert(submit("cornell-slide.glb", small("0-5")));
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 1500));
        kill_and_restart();
        EXPECT_EQ(known(), acknowledged);
    }
    for (const std::string& id : acknowledged) {
        const Outcome watch = afterglow({"watch", id});
        EXPECT_EQ(watch.exit, 0) << watch.err;
        EXPECT_EQ(job(id).at("frames_done"), 6);
    }
}

TEST_F(Durability, FinishedFramesAreNeitherTornNorComputedAgain) {
    const std::string id = submit("cornell-slide.glb", small("0-11"));
    std::map<int, std::string> before;
    while (before.size() < 4) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        before = finished(id);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(250));  // then a group is durable
    kill_and_restart();
    const auto after = finished(id);
    for (const auto& [frame, picture] : before) {
        ASSERT_TRUE(after.contains(frame)) << frame;
        EXPECT_EQ(after.at(frame), picture) << frame;
    }
    EXPECT_EQ(afterglow({"watch", id}).exit, 0);
    const auto whole = finished(id);
    EXPECT_EQ(whole.size(), 12U);
    for (const auto& [frame, picture] : before) EXPECT_EQ(whole.at(frame), picture) << frame;
}

TEST_F(Durability, AFullDiskIsAClearErrorAndHarmsNothing) {
    const std::string data = (folder_.path() / "small").string();
    // A limit on the size of files stands for a disk that is full.
    Process server({"/usr/bin/prlimit", "--fsize=90000", AFTERGLOW_BIN_DIR "/afterglowd", "serve", "--listen",
                    "127.0.0.1:0", "--data", data});
    const auto is_ready = [](const std::string& out) { return out.find('\n') != std::string::npos; };
    ASSERT_TRUE(server.wait_for_output(is_ready)) << server.err();
    const std::string out = server.out();
    const auto at = out.find("http://");
    const std::string url = out.substr(at, out.find('\n') - at);
    const auto scene = folder_.path() / "scene.json";
    std::ofstream(scene)
        << R"({"afterglow":1,"materials":[{"name":"lamp","emission":1}],"nodes":[{"name":"panel",
        "geometry":{"quad":{"size":[1,1]},"material":"lamp"}}]})"
        << std::string(200'000, ' ');
    Process submit({AFTERGLOW_BIN_DIR "/afterglow", "submit", scene.string(), "--server", url});
    EXPECT_NE(submit.wait(), 0);
    EXPECT_THAT(submit.err(), testing::HasSubstr("disk is full"));
    client::HttpConnection http(url, interrupt_);
    EXPECT_EQ(http.get("/healthz").status, 200);
    EXPECT_TRUE(std::filesystem::is_empty(std::filesystem::path(data) / "uploads")) << "nothing half-written";
}

TEST_F(Durability, ATerminatedServerKeepsItsJobs) {
    const std::string id = submit("living-room.glb", endless());
    server_->send_signal(SIGTERM);
    EXPECT_EQ(server_->wait(), 0) << server_->err();
    start_server();
    const std::string state = job(id).at("state");
    EXPECT_TRUE(state == "queued" || state == "running") << state;
    EXPECT_EQ(afterglow({"cancel", id}).exit, 0);
}

}  // namespace
}  // namespace afterglow::test
