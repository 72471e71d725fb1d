#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <iostream>
#include <set>
#include <thread>
#include <utility>

#include "client/event_stream.h"
#include "tests/service/service_fixture.h"

namespace afterglow::test {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

double percentile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

/// Many readers and submitters at once, each with a connection of its own.
class ProofOfLoad : public ServiceTest {
  protected:
    static constexpr int submitters = 20;
    static constexpr int streams_of_each = 5;
    static constexpr int frames = 3;
    const std::string settings_ = R"({"quality":"draft","rays":32,"width":32,"height":24,"frames":"0-)" +
                                  std::to_string(frames - 1) + "\"}";

    /// The frames whose final picture an event stream has told of by the job's end.
    std::set<int> watch(const std::string& id) {
        client::HttpConnection http(url_, interrupt_);
        client::EventStreamParser parser;
        std::set<int> seen;
        const auto sink = [&](std::string_view bytes) {
            for (const auto& event : parser.feed(bytes)) {
                if (event.name != "image") continue;
                const auto image = client::Json::parse(event.data);
                if (image.at("final") == true) seen.insert(image.at("frame").get<int>());
            }
            return client::StreamNext::more;
        };
        EXPECT_EQ(http.stream("/v1/jobs/" + id + "/events", {{"Last-Event-ID", "0"}}, sink).status, 200);
        return seen;
    }

    void submit_until(Clock::time_point until, const std::string& scene) {
        client::HttpConnection http(url_, interrupt_);
        while (Clock::now() < until) {
            const std::string id = submit_quickly(scene, settings_, http);
            std::vector<std::thread> readers;
            for (int i = 0; i < streams_of_each; ++i)
                readers.emplace_back([&] {
                    EXPECT_EQ(watch(id).size(), static_cast<std::size_t>(frames)) << id;
                    ++streams_;
                });
            for (std::thread& reader : readers) reader.join();
            ++jobs_;
        }
    }

    std::int64_t rss_kb() const {
        std::ifstream in("/proc/" + std::to_string(server_->pid()) + "/status");
        for (std::string word; in >> word;)
            if (word == "VmRSS:") break;
        std::int64_t kilobytes = 0;
        in >> kilobytes;
        return kilobytes;
    }

    void load(std::chrono::seconds length) {
        const std::string scene = upload("cornell-slide.glb");
        const auto began = Clock::now();
        std::vector<std::thread> threads;
        for (int i = 0; i < submitters; ++i)
            threads.emplace_back([&] { submit_until(began + length, scene); });
        std::vector<double> health;
        std::int64_t early_kb = 0;
        while (Clock::now() < began + length) {
            const auto asked = Clock::now();
            EXPECT_EQ(http_->get("/healthz").status, 200);
            health.push_back(Milliseconds(Clock::now() - asked).count());
            if (early_kb == 0 && Clock::now() > began + length / 3) early_kb = rss_kb();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        const std::int64_t late_kb = rss_kb();
        for (std::thread& thread : threads) thread.join();
        std::cout << jobs_ << " jobs and " << streams_ << " streams in " << length.count()
                  << " s; /healthz median " << percentile(health, 0.5) << " ms, p99 "
                  << percentile(health, 0.99) << " ms; resident " << early_kb / 1024 << " MiB after a third, "
                  << late_kb / 1024 << " MiB at the end\n";
        EXPECT_GT(jobs_, 0);
        // A job that has ended keeps its events, a few kilobytes.
        EXPECT_LT(late_kb - early_kb, 64 * 1024);
    }

    /// The time of one job of some frames.
    double job_seconds(const std::string& scene) {
        const auto began = Clock::now();
        const std::string id = submit_quickly(
            scene, R"({"quality":"draft","rays":64,"width":160,"height":120,"frames":"0-39"})");
        EXPECT_EQ(watch(id).size(), 40U);
        return std::chrono::duration<double>(Clock::now() - began).count();
    }

    std::atomic<int> jobs_ = 0;
    std::atomic<int> streams_ = 0;
};

TEST_F(ProofOfLoad, EveryStreamSeesEveryFinalFrame) {
    load(std::chrono::seconds(20));
}

TEST_F(ProofOfLoad, SlowEveryStreamSeesEveryFinalFrameForFiveMinutes) {
    load(std::chrono::seconds(300));
}

TEST_F(ProofOfLoad, SlowIdleStreamsCostNoFrames) {
    const std::string scene = upload("cornell-slide.glb");
    const std::string resting = submit_quickly(scene, settings_);
    const std::string held = submit("living-room.glb", endless());
    EXPECT_EQ(http_->post("/v1/jobs/" + held + "/pause", "", "application/json").status, 200);
    watch(resting);
    job_seconds(scene);  // fills the cache
    std::vector<double> alone;
    std::vector<double> watched;
    for (int round = 0; round < 9; ++round) {
        alone.push_back(job_seconds(scene));
        std::vector<std::thread> idle;
        std::atomic<int> open = 0;
        std::atomic<bool> over = false;
        for (int i = 0; i < 100; ++i)
            idle.emplace_back([&] {
                client::HttpConnection http(url_, interrupt_);
                bool counted = false;
                http.stream("/v1/jobs/" + held + "/events", {}, [&](std::string_view) {
                    if (!std::exchange(counted, true)) ++open;
                    return over ? client::StreamNext::stop : client::StreamNext::more;
                });
            });
        while (open < 100) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        watched.push_back(job_seconds(scene));
        over = true;
        for (std::thread& thread : idle) thread.join();  // at the next heartbeat
    }
    std::cout << "40 frames: median " << percentile(alone, 0.5) << " s alone, " << percentile(watched, 0.5)
              << " s beside 100 idle streams: ratio " << percentile(watched, 0.5) / percentile(alone, 0.5)
              << "\n";
    EXPECT_EQ(afterglow({"cancel", held}).exit, 0);
}

}  // namespace
}  // namespace afterglow::test
