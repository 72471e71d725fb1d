// What a service that runs for long does with many jobs that have ended, and how many a client may have at a
// time.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/api/service.h"
#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

class LongLife : public testing::Test {
  protected:
    Reply ask(const std::string& method, const std::string& path, const std::string& body = "",
              std::map<std::string, std::string> headers = {}, const Client& client = {}) {
        headers.emplace("content-type", "application/json");
        Request request{method, path, {}, std::move(headers), body};
        request.client = client;
        return service_.router().handle(request);
    }
    Json json(const std::string& path) { return parse_json(ask("GET", path).body, "reply"); }
    std::string submit(const std::string& settings, const Client& client = {}) {
        const Reply scene =
            ask("POST", "/v1/scenes", "bytes", {{"content-type", "model/gltf-binary"}}, client);
        const Json request = {{"scene", parse_json(scene.body, "scene").at("id")},
                              {"settings", parse_json(settings, "settings")}};
        const Reply reply = ask("POST", "/v1/jobs", request.dump(), {}, client);
        EXPECT_EQ(reply.status, 201) << reply.body;
        return parse_json(reply.body, "job").at("id").get<std::string>();
    }
    std::string events_of(const std::string& id) {
        const Reply reply = ask("GET", "/v1/jobs/" + id + "/events", "", {{"last-event-id", "0"}});
        std::string all;
        for (bool more = reply.stream != nullptr; more;) {
            const Piece piece = reply.stream->next();
            all += piece.bytes;
            more = piece.then == Piece::Then::more;
        }
        return all;
    }
    std::string ended_job(const std::string& settings = R"({"frames":"0-5"})", const Client& client = {}) {
        const std::string id = submit(settings, client);
        EXPECT_THAT(events_of(id), HasSubstr("event: end"));
        return id;
    }

    ScratchFolder folder_;
    FakeSolver solver_;
    Service service_{{folder_.path(), 1, 4, {}, {}, {}, {}, 0, 3}, {fake_scene, solver_.factory()}};
};

TEST_F(LongLife, WhatIsHeldInMemoryDoesNotGrowWithEndedJobs) {
    std::vector<std::string> ids;
    for (int k = 0; k < 10; ++k) ids.push_back(ended_job());
    const Service::Held early = service_.held();
    EXPECT_EQ(early.jobs.jobs, 3U);
    EXPECT_EQ(early.jobs_with_frames, 3U);
    for (int k = 0; k < 50; ++k) ids.push_back(ended_job());
    const Service::Held late = service_.held();
    EXPECT_EQ(late.jobs.jobs, 3U);
    // Progress is told by the clock, so that a job may have some events more; all sixty would be twenty times
    // as many.
    EXPECT_LE(late.jobs.events, 2 * early.jobs.events);
    EXPECT_EQ(late.jobs_with_frames, 3U);

    // They are all there nevertheless.
    EXPECT_EQ(json("/v1/jobs").at("jobs").size(), ids.size());
    EXPECT_THAT(ask("GET", "/metrics").body, HasSubstr("afterglow_jobs{state=\"succeeded\"} 60\n"));
    EXPECT_THAT(ask("GET", "/metrics").body, HasSubstr("afterglow_frames 360\n"));
    for (const std::string& id : {ids.front(), ids[30], ids.back()}) {
        EXPECT_EQ(json("/v1/jobs/" + id).at("frames_done"), 6);
        EXPECT_EQ(json("/v1/jobs/" + id + "/frames").at("frames").size(), 6U);
        EXPECT_EQ(ask("GET", "/v1/jobs/" + id + "/frames/4/image").status, 200);
        EXPECT_EQ(ask("GET", "/v1/jobs/" + id + "/frames/6/image").status, 404);
        EXPECT_THAT(events_of(id), HasSubstr("\"frame\":5"));
    }
    EXPECT_EQ(service_.held().jobs.jobs, 3U) << "looking leaves nothing behind";
}

TEST_F(LongLife, AnOldJobIsTriedAgainAndRemoved) {
    const std::string failed = ended_job(R"({"frames":"0-3","seed":13})");
    const std::string cancelled = submit(R"({"frames":"0-3","seed":15})");
    while (ask("POST", "/v1/jobs/" + cancelled + "/cancel").status != 200) {
    }
    for (int k = 0; k < 10; ++k) ended_job();
    EXPECT_EQ(json("/v1/jobs/" + failed).at("frames_done"), 1);
    const auto steps = solver_.steps().size();
    EXPECT_EQ(ask("POST", "/v1/jobs/" + failed + "/retry").status, 200);
    EXPECT_THAT(events_of(failed), HasSubstr("event: end"));
    EXPECT_EQ(json("/v1/jobs/" + failed).at("state"), "failed");
    EXPECT_EQ(solver_.steps().at(steps).second, 1) << "it goes on after its last finished frame";
    EXPECT_EQ(ask("DELETE", "/v1/jobs/" + cancelled).status, 200);
    EXPECT_EQ(ask("GET", "/v1/jobs/" + cancelled).status, 404);
    EXPECT_EQ(ask("GET", "/v1/jobs/" + cancelled + "/events").status, 404);
}

TEST_F(LongLife, JobsThatGoOnAgainCountAmongTheUnfinished) {
    Client bob;
    bob.name = "bob";
    bob.role = Role::submitter;
    bob.quota.jobs = 1;
    const std::string failed = ended_job(R"({"frames":"0-3","seed":13})", bob);
    const std::string succeeded = ended_job(R"({"frames":"0-3"})", bob);
    solver_.close();
    const std::string running = submit(R"({"frames":"0-3"})", bob);
    const std::string dim = R"({"edits":[{"camera":{"position":[1,1,1],"look_at":[0,0,0]}}]})";
    const auto retry = [&](const Client& client) {
        return ask("POST", "/v1/jobs/" + failed + "/retry", "", {}, client);
    };
    const auto edit = [&](const std::string& id) {
        return ask("POST", "/v1/jobs/" + id + "/edits", dim, {{"if-match", "*"}}, bob);
    };
    EXPECT_EQ(retry(bob).status, 429);
    EXPECT_EQ(edit(succeeded).status, 429);
    EXPECT_EQ(edit(running).status, 200) << "it counts already";
    EXPECT_EQ(json("/v1/jobs/" + succeeded).at("state"), "succeeded");
    EXPECT_EQ(json("/v1/jobs/" + failed).at("state"), "failed");
    Client admin;
    admin.name = "admin";
    admin.role = Role::admin;
    admin.quota.jobs = 0;
    EXPECT_EQ(retry(admin).status, 200) << "what others do is not counted";
    solver_.open();
    for (const std::string& id : {running, failed}) EXPECT_THAT(events_of(id), HasSubstr("event: end"));
    EXPECT_EQ(edit(succeeded).status, 200);
    EXPECT_THAT(events_of(succeeded), HasSubstr("event: end"));
}

}  // namespace
}  // namespace afterglow
