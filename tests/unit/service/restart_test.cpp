#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/api/service.h"
#include "tests/unit/service/fake_solver.h"
#include "tests/unit/service/replies.h"

// A service that ends and begins again in the same folder.

namespace afterglow {
namespace {

using testing::HasSubstr;

class Restart : public testing::Test {
  protected:
    void SetUp() override { start(); }
    void start() {
        service_ =
            std::make_unique<Service>(ServiceConfig{folder_.path(), 1, 4, {}, ServiceConfig::AtStop::keep},
                                      ServiceParts{fake_scene, solver_.factory()});
    }
    void restart() {
        solver_.open();  // a step in hand comes to its end
        service_.reset();
        start();
    }
    Reply ask(const std::string& method, const std::string& path, const std::string& body = "",
              std::map<std::string, std::string> query = {},
              std::map<std::string, std::string> headers = {}) {
        headers.emplace("content-type", "application/json");
        return service_->router().handle({method, path, std::move(query), std::move(headers), body});
    }
    Json json(const std::string& method, const std::string& path, const std::string& body = "") {
        return parse_json(ask(method, path, body).body, "reply");
    }
    std::string upload() {
        const Reply reply = service_->router().handle(
            {"POST", "/v1/scenes", {}, {{"content-type", "model/gltf-binary"}}, "bytes"});
        return parse_json(reply.body, "scene").at("id").get<std::string>();
    }
    std::string request(const std::string& settings) {
        return R"({"scene":")" + upload() + R"(","settings":)" + settings + "}";
    }
    std::string submit(const std::string& settings) {
        return json("POST", "/v1/jobs", request(settings)).at("id").get<std::string>();
    }
    std::string state(const std::string& id) {
        return json("GET", "/v1/jobs/" + id).at("state").get<std::string>();
    }
    std::string wait_for_end(const std::string& id) {
        for (;;) {
            const Reply reply = ask("GET", "/v1/jobs/" + id, "", {{"wait", "10"}});
            const Json job = parse_json(read_to_end(reply), "job");
            if (!job.at("ended").is_null()) return job.at("state").get<std::string>();
        }
    }

    ScratchFolder folder_;
    FakeSolver solver_;
    std::unique_ptr<Service> service_;
};

TEST_F(Restart, WhatWasFinishedIsThereAndIsNotComputedAgain) {
    const std::string id = submit(R"({"frames":"0-4","width":32,"seed":7,"background":[0.1,0.2,0.3]})");
    EXPECT_EQ(wait_for_end(id), "succeeded");
    const Json before = json("GET", "/v1/jobs/" + id);
    const std::string picture = ask("GET", "/v1/jobs/" + id + "/frames/3/image").body;
    const auto steps = solver_.steps().size();
    restart();
    Json after = json("GET", "/v1/jobs/" + id);
    EXPECT_EQ(after, before);
    EXPECT_EQ(ask("GET", "/v1/jobs/" + id + "/frames/3/image").body, picture);
    EXPECT_EQ(json("GET", "/v1/jobs/" + id + "/frames").at("frames").size(), 5U);
    EXPECT_EQ(solver_.steps().size(), steps);
}

TEST_F(Restart, ARunningJobGoesOnAfterItsLastFinishedFrame) {
    const std::string id = submit(R"({"frames":"0-30"})");
    while (solver_.steps().size() < 5) std::this_thread::yield();
    restart();
    EXPECT_EQ(wait_for_end(id), "succeeded");
    EXPECT_EQ(json("GET", "/v1/jobs/" + id).at("frames_done"), 31);
    std::map<int, int> times;
    for (const auto& [job, frame] : solver_.steps()) ++times[frame];
    EXPECT_EQ(times.size(), 31U);
    int again = 0;
    for (const auto& [frame, count] : times) again += count - 1;
    EXPECT_LE(again, 1) << "only the frame in hand at the stop";
}

TEST_F(Restart, FilesOfUnfinishedFramesAreRemoved) {
    const std::string id = submit(R"({"frames":"0"})");
    wait_for_end(id);
    const auto folder = folder_.path() / "jobs" / id;
    std::ofstream(folder / "frame_0001.2.png") << "torn";
    std::ofstream(folder / "frame_0001.3.png.part") << "torn";
    restart();
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename());
    EXPECT_THAT(names, testing::ElementsAre("frame_0000.4.exr", "frame_0000.4.png"));
}

TEST_F(Restart, AStreamIsRejoinedWithAnIdOfAnEarlierLife) {
    const std::string id = submit(R"({"frames":"0-2"})");
    wait_for_end(id);
    restart();
    const Reply reply = ask("GET", "/v1/jobs/" + id + "/events", "", {}, {{"last-event-id", "3"}});
    ASSERT_EQ(reply.status, 200) << reply.body;
    std::string all;
    for (;;) {
        const Piece piece = reply.stream->next();
        all += piece.bytes;
        if (piece.then == Piece::Then::end) break;
    }
    EXPECT_THAT(all, HasSubstr("\"frame\":2"));
    EXPECT_THAT(all, HasSubstr("event: end\ndata: {\"state\":\"succeeded\"}"));
    EXPECT_THAT(all, HasSubstr("id: 1000000001\n"));
}

TEST_F(Restart, PrioritiesHoldAgain) {
    solver_.close();
    const std::string first = submit(R"({"frames":"0-2"})");
    const std::string low = submit(R"({"frames":"0-2"})");
    const std::string high = submit(R"({"frames":"0-2"})");
    const Reply changed = ask("PATCH", "/v1/jobs/" + high, R"({"priority": 9})", {},
                              {{"content-type", "application/merge-patch+json"}});
    EXPECT_EQ(changed.status, 200) << changed.body;
    restart();
    EXPECT_EQ(json("GET", "/v1/jobs/" + high).at("priority"), 9);
    EXPECT_EQ(json("GET", "/v1/jobs/" + low).at("priority"), 0);
    for (const std::string& id : {first, low, high}) EXPECT_EQ(wait_for_end(id), "succeeded");
}

TEST_F(Restart, PausedJobsStayPausedUntilTheyAreResumed) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0-2"})");
    EXPECT_EQ(ask("POST", "/v1/jobs/" + id + "/pause").status, 200);
    restart();
    EXPECT_EQ(state(id), "paused");
    EXPECT_EQ(ask("POST", "/v1/jobs/" + id + "/pause").status, 409);
    EXPECT_EQ(ask("POST", "/v1/jobs/" + id + "/retry").status, 409);
    EXPECT_EQ(ask("POST", "/v1/jobs/" + id + "/resume").status, 200);
    EXPECT_EQ(wait_for_end(id), "succeeded");
}

TEST_F(Restart, AFailedJobIsTriedAgainAfterItsLastFinishedFrame) {
    const std::string id = submit(R"({"frames":"0-3","seed":13})");
    EXPECT_EQ(wait_for_end(id), "failed");
    restart();
    EXPECT_EQ(state(id), "failed");
    const auto steps = solver_.steps().size();
    EXPECT_EQ(ask("POST", "/v1/jobs/" + id + "/retry").status, 200);
    EXPECT_EQ(wait_for_end(id), "failed");
    ASSERT_GT(solver_.steps().size(), steps);
    EXPECT_EQ(solver_.steps()[steps].second, 1);
}

TEST_F(Restart, TheSameKeyGivesTheSameJobAlsoInTheNextLife) {
    const std::string body = request(R"({"frames":"0"})");
    const auto post = [&](const std::string& text) {
        return ask("POST", "/v1/jobs", text, {}, {{"idempotency-key", "k1"}});
    };
    const std::string id = parse_json(post(body).body, "job").at("id").get<std::string>();
    EXPECT_EQ(parse_json(post(body).body, "job").at("id"), id);
    restart();
    EXPECT_EQ(parse_json(post(body).body, "job").at("id"), id);
    EXPECT_EQ(post(body + " ").status, 422);
    EXPECT_EQ(json("GET", "/v1/jobs").at("jobs").size(), 1U);
}

TEST_F(Restart, ARemovedJobStaysAway) {
    const std::string id = submit(R"({"frames":"0-1"})");
    wait_for_end(id);
    const Reply dry = ask("DELETE", "/v1/jobs/" + id, "", {{"dry_run", "1"}});
    EXPECT_EQ(parse_json(dry.body, "reply").at("removed"), false);
    EXPECT_GT(parse_json(dry.body, "reply").at("bytes"), 0);
    EXPECT_EQ(state(id), "succeeded");
    EXPECT_EQ(ask("DELETE", "/v1/jobs/" + id).status, 200);
    EXPECT_EQ(ask("GET", "/v1/jobs/" + id).status, 404);
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "jobs" / id));
    restart();
    EXPECT_EQ(ask("GET", "/v1/jobs/" + id).status, 404);
}

TEST_F(Restart, JobsAreListedInPagesAndByState) {
    std::vector<std::string> ids;
    for (int i = 0; i < 5; ++i) ids.push_back(submit(R"({"frames":"0"})"));
    for (const auto& id : ids) wait_for_end(id);
    std::vector<std::string> seen;
    std::map<std::string, std::string> query = {{"limit", "2"}, {"state", "succeeded"}};
    for (;;) {
        const Json page = parse_json(ask("GET", "/v1/jobs", "", query).body, "page");
        for (const Json& job : page.at("jobs")) seen.push_back(job.at("id").get<std::string>());
        if (page.at("next").is_null()) break;
        query["cursor"] = page.at("next").get<std::string>();
    }
    std::reverse(seen.begin(), seen.end());
    EXPECT_EQ(seen, ids);
    EXPECT_EQ(ask("GET", "/v1/jobs", "", {{"state", "odd"}}).status, 422);
    EXPECT_EQ(ask("GET", "/v1/jobs", "", {{"cursor", "odd"}}).status, 410);
}

/// Requests in any order, with restarts between them, against what must be true of a job's state.
TEST_F(Restart, StatesFollowAModelThroughAnyRequests) {
    const std::map<std::string, std::map<std::string, std::string>> model = {
        {"pause", {{"queued", "paused"}, {"running", "paused"}}},
        {"resume", {{"paused", "queued"}}},
        {"cancel", {{"queued", "cancelled"}, {"running", "cancelled"}, {"paused", "cancelled"}}},
        {"retry", {{"failed", "queued"}, {"cancelled", "queued"}}}};
    std::vector<std::string> actions = {"submit", "restart", "remove"};
    for (const auto& [name, rules] : model) actions.insert(actions.end(), 3, name);
    std::mt19937 random(1);
    std::map<std::string, std::string> states;  // as the model has them; "active" for queued or running
    solver_.close();                            // nothing finishes by itself
    const auto shown = [&](const std::string& id) {
        const std::string now = state(id);
        return now == "queued" || now == "running" ? std::string("active") : now;
    };
    for (int turn = 0; turn < 300; ++turn) {
        const std::string action = actions[random() % actions.size()];
        if (action == "submit" || states.empty()) {
            states[submit(R"({"frames":"0-3","seed":15})")] = "active";  // it hangs until it is stopped
        } else if (action == "restart") {
            restart();
            solver_.close();
        } else {
            const auto it = std::next(states.begin(), static_cast<long>(random() % states.size()));
            const std::string id = it->first;
            if (action == "remove") {
                const bool legal = it->second != "active" && it->second != "paused";
                EXPECT_EQ(ask("DELETE", "/v1/jobs/" + id).status, legal ? 200 : 409) << it->second;
                if (legal) states.erase(it);
            } else {
                const std::string from = it->second == "active" ? "queued" : it->second;
                const auto rule = model.at(action).find(from);
                const bool legal = rule != model.at(action).end();
                EXPECT_EQ(ask("POST", "/v1/jobs/" + id + "/" + action).status, legal ? 200 : 409)
                    << action << " " << it->second;
                if (legal) it->second = rule->second == "queued" ? "active" : rule->second;
            }
        }
        for (const auto& [id, expected] : states) ASSERT_EQ(shown(id), expected) << "turn " << turn;
        ASSERT_EQ(json("GET", "/v1/jobs").at("jobs").size(), states.size());
    }
    solver_.open();
}

TEST_F(Restart, ConvergenceIsToldAsJsonAndCsv) {
    const std::string id = submit(R"({"frames":"0-2"})");
    wait_for_end(id);
    restart();
    const Json rows = json("GET", "/v1/jobs/" + id + "/convergence").at("frames");
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[2].at("frame"), 2);
    EXPECT_EQ(rows[2].at("error_bound"), 0.125);
    EXPECT_GE(rows[2].at("seconds"), rows[0].at("seconds"));
    const std::string csv = ask("GET", "/v1/jobs/" + id + "/convergence", "", {{"type", "csv"}}).body;
    EXPECT_THAT(csv, testing::StartsWith("frame,seconds,residual,error_bound,picture_error\n0,"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
    EXPECT_EQ(ask("GET", "/v1/jobs/" + id + "/convergence", "", {{"type", "xml"}}).status, 422);
}

TEST_F(Restart, ReadinessAndMetricsAreTold) {
    const std::string id = submit(R"({"frames":"0-2"})");
    wait_for_end(id);
    EXPECT_EQ(ask("GET", "/readyz").status, 200);
    const std::string metrics = ask("GET", "/metrics").body;
    EXPECT_THAT(metrics, HasSubstr("afterglow_jobs{state=\"succeeded\"} 1\n"));
    EXPECT_THAT(metrics, HasSubstr("afterglow_frames 3\n"));
}

}  // namespace
}  // namespace afterglow
