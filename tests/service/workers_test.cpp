#include <chrono>
#include <csignal>
#include <iostream>
#include <random>
#include <thread>

#include "tests/service/service_fixture.h"

namespace afterglow::test {
namespace {

using testing::HasSubstr;

/// The processes that compute jobs, killed at moments of no good.
class Workers : public ServiceTest {
  protected:
    /// The one process that computes; waits for it.
    pid_t worker() const {
        for (;;) {
            if (const auto pids = server_->children(); !pids.empty()) return pids.front();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    void kill_worker(int number) const {
        const pid_t pid = worker();
        ::kill(pid, number);
        while (is_running(pid)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    /// A job in which every frame is computed from nothing, so that its bits do not depend on where a process
    /// began.
    static std::vector<std::string> cold(const std::string& frames) {
        auto options = small(frames);
        options.insert(options.end(), {"--method", "full"});
        return options;
    }
    int frames_done(const std::string& id) { return job(id).at("frames_done").get<int>(); }
};

TEST_F(Workers, AJobWhoseWorkersDieHasThePicturesOfOneThatWasLeftInPeace) {
    const std::string calm = submit("cornell-slide.glb", cold("0-19"));
    EXPECT_EQ(afterglow({"watch", calm}).exit, 0);
    const std::string id = submit("cornell-slide.glb", cold("0-19"));
    std::mt19937 random(1);
    int kills = 0;
    for (int done = 0; done < 20;) {
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 60));
        if (job(id).at("state") == "succeeded") break;
        const auto pids = server_->children();
        if (pids.empty()) continue;
        ::kill(pids.front(), SIGSEGV);
        ++kills;
        // Two deaths at one frame are borne, so the job may go on a little.
        const int before = frames_done(id);
        while (done <= before && job(id).at("state") == "running") done = frames_done(id);
    }
    EXPECT_EQ(afterglow({"watch", id}).exit, 0) << job(id).dump(1);
    EXPECT_GT(kills, 0);
    EXPECT_EQ(finished(id), finished(calm));
    EXPECT_THAT(job(id).at("warnings").dump(), HasSubstr("signal 11 (SEGV)"));
    std::cout << kills << " workers killed\n";
}

TEST_F(Workers, ThreeDeathsAtOneFrameFailTheJob) {
    const std::string id = submit("living-room.glb", endless());
    for (int strike = 0; strike < 3; ++strike) kill_worker(SIGABRT);
    EXPECT_EQ(afterglow({"watch", id}).exit, 1);
    const auto error = job(id).at("error");
    EXPECT_EQ(error.at("code"), "worker_died");
    EXPECT_EQ(error.at("place"), "frame 0");
    EXPECT_THAT(error.at("detail").get<std::string>(), HasSubstr("signal 6 (ABRT)"));
    EXPECT_TRUE(server_->children().empty());
    // Tried again it begins with a clean slate.
    EXPECT_EQ(http_->post("/v1/jobs/" + id + "/retry", "", "application/json").status, 200);
    kill_worker(SIGKILL);
    worker();
    EXPECT_EQ(job(id).at("state"), "running");
    EXPECT_EQ(afterglow({"cancel", id}).exit, 0);
}

TEST_F(Workers, StrikesOutliveTheServerAndItsOwnDeathIsNone) {
    const std::string id = submit("living-room.glb", endless());
    kill_worker(SIGSEGV);
    kill_worker(SIGSEGV);
    // The second strike is on disk once another worker has begun.
    worker();
    for (int round = 0; round < 3; ++round) {
        server_->send_signal(SIGKILL);
        server_->wait();
        start_server();
        worker();
    }
    const std::string state = job(id).at("state");
    EXPECT_TRUE(state == "queued" || state == "running") << state;
    kill_worker(SIGSEGV);
    EXPECT_EQ(afterglow({"watch", id}).exit, 1);
    EXPECT_EQ(job(id).at("error").at("code"), "worker_died");
}

TEST_F(Workers, NoneOutlivesAServerThatIsKilled) {
    submit("living-room.glb", endless());
    submit("cornell-slide.glb", endless());
    std::vector<pid_t> pids;
    while (pids.size() < 2) pids = server_->children();
    server_->send_signal(SIGKILL);
    server_->wait();
    for (const pid_t pid : pids)
        while (is_running(pid)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    start_server();
    for (const pid_t pid : pids) EXPECT_FALSE(is_running(pid));
}

TEST_F(Workers, CancellingFreesTheMachineAtOnce) {
    const std::string id = submit("living-room.glb", endless());
    const pid_t pid = worker();
    const auto began = std::chrono::steady_clock::now();
    EXPECT_EQ(http_->post("/v1/jobs/" + id + "/cancel", "", "application/json").status, 200);
    while (is_running(pid)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
    std::cout << "a worker ended " << took.count() << " ms after its job was cancelled\n";
    EXPECT_EQ(job(id).at("state"), "cancelled");
}

TEST_F(Workers, AStoppedServerTakesItsWorkersAlong) {
    const std::string id = submit("living-room.glb", endless());
    const pid_t pid = worker();
    server_->send_signal(SIGTERM);
    EXPECT_EQ(server_->wait(), 0);
    EXPECT_FALSE(is_running(pid));
    start_server();
    EXPECT_THAT(job(id).at("warnings").dump(), testing::Not(HasSubstr("began anew")));
    EXPECT_EQ(afterglow({"cancel", id}).exit, 0);
}

}  // namespace
}  // namespace afterglow::test
