#include <algorithm>
#include <csignal>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include "tests/service/service_fixture.h"

namespace afterglow::test {
namespace {

/// What is known of a picture that must never change again.
struct KeptFile {
    std::filesystem::file_time_type written;
    std::string bytes;
    bool operator==(const KeptFile&) const = default;
};

/// The server is killed at random moments while fifty jobs run. Every frame is computed from nothing, so that
/// equal frames of all jobs must be equal to the byte wherever a process began.
class ProofOfKills : public ServiceTest {
  protected:
    static constexpr std::size_t job_count = 50;

    void kill_often(int kills, const std::string& frames) {
        std::mt19937 random(1);
        const std::string scene = upload("cornell-slide.glb");
        std::set<std::string> acknowledged;
        int done = 0;
        for (; done < kills; ++done) {
            // A submission may be under way when the server is killed: it counts once it is acknowledged.
            const auto until =
                std::chrono::steady_clock::now() + std::chrono::milliseconds(random() % 500 + 1);
            std::thread killer([&] {
                std::this_thread::sleep_until(until);
                server_->send_signal(SIGKILL);
            });
            while (acknowledged.size() < job_count && submit_one(scene, frames, acknowledged)) {
            }
            killer.join();
            server_->wait();
            const auto start = std::filesystem::file_time_type::clock::now();
            start_server();
            look(acknowledged, start);
        }
        while (acknowledged.size() < job_count) ASSERT_TRUE(submit_one(scene, frames, acknowledged));
        for (const std::string& id : acknowledged) EXPECT_EQ(afterglow({"watch", id}).exit, 0) << id;
        look(acknowledged, std::filesystem::file_time_type::clock::now());
        compare(acknowledged);
        std::cout << done << " kills, " << acknowledged.size() << " jobs, " << kept_.size()
                  << " pictures, none lost, torn or computed again\n";
    }

  private:
    bool submit_one(const std::string& scene, const std::string& frames, std::set<std::string>& ids) {
        try {
            ids.insert(submit_quickly(
                scene, R"({"method":"full","quality":"draft","rays":32,"width":32,"height":24,"frames":")" +
                           frames + "\"}"));
            return true;
        } catch (const std::exception&) {
            return false;  // the server is gone
        }
    }

    /// What was written before a start and is there after it was durable, and must never change again.
    void look(const std::set<std::string>& acknowledged, std::filesystem::file_time_type start) {
        std::set<std::string> known;
        const auto listed = client::Json::parse(http_->get("/v1/jobs").body);
        for (const auto& job : listed.at("jobs")) known.insert(job.at("id").get<std::string>());
        EXPECT_TRUE(std::includes(known.begin(), known.end(), acknowledged.begin(), acknowledged.end()));
        std::map<std::pair<std::string, int>, KeptFile> now;
        for (const std::string& id : known) {
            const auto reply = client::Json::parse(http_->get("/v1/jobs/" + id + "/frames").body);
            for (const auto& frame : reply.at("frames"))
                if (KeptFile file; frame.at("final") == true && (file = file_of(id, frame)).written < start)
                    now[{id, frame.at("frame").get<int>()}] = std::move(file);
        }
        for (const auto& [which, file] : kept_) {
            ASSERT_TRUE(now.contains(which)) << which.first << " frame " << which.second << " is lost";
            EXPECT_TRUE(now.at(which) == file) << which.first << " frame " << which.second << " has changed";
        }
        kept_ = std::move(now);
    }

    KeptFile file_of(const std::string& id, const client::Json& frame) const {
        std::string number = std::to_string(frame.at("frame").get<int>());
        number.insert(0, 4 - number.size(), '0');
        const auto path =
            folder_.path() / "data" / "jobs" / id /
            ("frame_" + number + "." + std::to_string(frame.at("revision").get<int>()) + ".exr");
        std::ifstream in(path, std::ios::binary);
        return {std::filesystem::last_write_time(path), {std::istreambuf_iterator<char>(in), {}}};
    }

    void compare(const std::set<std::string>& acknowledged) const {
        std::map<int, std::string> first;
        for (const auto& [which, file] : kept_) {
            if (!acknowledged.contains(which.first)) continue;
            const auto& expected = first.emplace(which.second, file.bytes).first->second;
            EXPECT_TRUE(file.bytes == expected) << which.first << " frame " << which.second;
        }
    }

    std::map<std::pair<std::string, int>, KeptFile> kept_;
};

TEST_F(ProofOfKills, FiveKillsLoseNothing) {
    kill_often(5, "0-2");
}

TEST_F(ProofOfKills, SlowTwoHundredKillsLoseNothing) {
    kill_often(200, "0-39");
}

}  // namespace
}  // namespace afterglow::test
