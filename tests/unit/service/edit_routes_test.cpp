#include <functional>
#include <map>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/api/service.h"
#include "tests/unit/service/fake_solver.h"
#include "tests/unit/service/replies.h"

// Edits of jobs through the routes, with a fake solver: what is accepted, what becomes stale, what lasts.

namespace afterglow {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

/// The triangle that shines, called as one of two lamps beside it.
Scene scene_with_lamps(std::string_view bytes, const SceneUpload& upload) {
    Scene scene = fake_scene(bytes, upload);
    for (const std::string name : {"bulb", "lamp", "off"}) {
        Light& light = scene.lights.emplace_back();
        light.name = name;
        if (name != "off") light.intensity = Rgb(4, 2, 0);
        Node& node = scene.nodes.emplace_back();
        node.name = name;
        node.light = static_cast<Index>(scene.lights.size()) - 1;
    }
    return scene;
}

class EditRoutes : public testing::Test {
  protected:
    void SetUp() override { start(); }
    void TearDown() override { solver_.open(); }
    void start() {
        service_ =
            std::make_unique<Service>(ServiceConfig{folder_.path(), 1, 4, {}, ServiceConfig::AtStop::keep},
                                      ServiceParts{scene_with_lamps, solver_.factory()});
    }
    void restart() {
        solver_.open();  // a step in hand comes to its end
        service_.reset();
        start();
    }
    Reply ask(const std::string& method, const std::string& path, const std::string& body = "",
              std::map<std::string, std::string> headers = {}) {
        headers.emplace("content-type", "application/json");
        return service_->router().handle({method, path, {}, std::move(headers), body});
    }
    Json json(const std::string& path) { return parse_json(ask("GET", path).body, "reply"); }
    std::string submit(const std::string& settings) {
        const Reply scene = service_->router().handle(
            {"POST", "/v1/scenes", {}, {{"content-type", "model/gltf-binary"}}, "bytes"});
        const Json request = {{"scene", parse_json(scene.body, "scene").at("id")},
                              {"settings", parse_json(settings, "settings")}};
        return parse_json(ask("POST", "/v1/jobs", request.dump()).body, "job").at("id").get<std::string>();
    }
    Json job(const std::string& id) { return json("/v1/jobs/" + id); }
    std::string etag(const std::string& id) {
        for (const auto& [name, value] : ask("GET", "/v1/jobs/" + id).headers)
            if (name == "ETag") return value;
        return "";
    }
    Reply edit(const std::string& id, const std::string& edits, const std::string& tag) {
        return ask("POST", "/v1/jobs/" + id + "/edits", R"({"edits":[)" + edits + "]}", {{"if-match", tag}});
    }
    Reply edit(const std::string& id, const std::string& edits) { return edit(id, edits, etag(id)); }
    void wait_until(const std::function<bool()>& condition) {
        while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    void wait_for_end(const std::string& id) {
        wait_until([&] { return !job(id).at("ended").is_null(); });
        EXPECT_EQ(job(id).at("state"), "succeeded");
    }
    std::vector<bool> stale_frames(const std::string& id) {
        std::vector<bool> stale;
        const Json reply = json("/v1/jobs/" + id + "/frames");
        for (const Json& frame : reply.at("frames")) stale.push_back(frame.at("stale").get<bool>());
        return stale;
    }
    std::string all_events(const std::string& id) {
        return read_to_end(ask("GET", "/v1/jobs/" + id + "/events", "", {{"last-event-id", "0"}}));
    }
    void expect_problem(const Reply& reply, int status, const std::string& place) {
        EXPECT_EQ(reply.status, status) << reply.body;
        EXPECT_EQ(reply.content_type, "application/problem+json");
        EXPECT_EQ(parse_json(reply.body, "problem").value("place", ""), place) << reply.body;
    }

    static constexpr const char* dim = R"({"light":{"material":"lamp","emission_scale":0.5}})";
    static constexpr const char* nudge = R"({"move":{"node":"triangle","translation":[0.1,0,0]}})";

    ScratchFolder folder_;
    FakeSolver solver_;
    std::unique_ptr<Service> service_;
};

TEST_F(EditRoutes, AnEditOfARunningJobIsTakenOverAndItsFramesAreComputedAgain) {
    solver_.close_after(3);
    const std::string id = submit(R"({"frames":"0-20"})");
    EXPECT_EQ(etag(id), "\"0\"");
    wait_until([&] { return job(id).at("frames_done") == 3; });
    const Reply reply = edit(id, std::string(dim) + "," + nudge);
    ASSERT_EQ(reply.status, 200) << reply.body;
    const Json edited = parse_json(reply.body, "job");
    EXPECT_EQ(edited.at("revision"), 1);
    EXPECT_EQ(edited.at("frames_done"), 0);
    EXPECT_EQ(edited.at("stale_frames"), 3);
    EXPECT_THAT(stale_frames(id), Each(true));
    EXPECT_EQ(etag(id), "\"1\"");
    solver_.open();
    wait_for_end(id);
    EXPECT_THAT(solver_.edits(), ElementsAre("light", "move")) << "by the run that there was";
    EXPECT_THAT(stale_frames(id), Each(false));
    EXPECT_EQ(job(id).at("frames_done"), 21);
    EXPECT_EQ(job(id).at("stale_frames"), 0);
    EXPECT_EQ(job(id).at("reused"), 0.25) << "half of the lines by either";
    const Json frame = json("/v1/jobs/" + id + "/frames").at("frames")[0];
    EXPECT_EQ(frame.at("revision"), 1004);
    EXPECT_EQ(frame.at("job_revision"), 1);
    const std::string events = all_events(id);
    EXPECT_THAT(events, HasSubstr("event: edit\ndata: {\"revision\":1,\"first_frame\":0,"));
    EXPECT_THAT(events, HasSubstr("event: reused\ndata: {\"revision\":1,\"reused\":0.25}"));
    EXPECT_LT(events.find("event: edit"), events.find("event: reused"));
}

TEST_F(EditRoutes, ARevisionThatIsGoneOrMissingIsRefused) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0-2"})");
    const std::string tag = etag(id);
    expect_problem(edit(id, dim, ""), 428, "If-Match");
    EXPECT_EQ(edit(id, dim, tag).status, 200);
    expect_problem(edit(id, dim, tag), 412, "If-Match");
    expect_problem(edit(id, dim, "W/\"1\""), 412, "If-Match");
    expect_problem(edit(id, dim, "1"), 412, "If-Match");
    EXPECT_EQ(job(id).at("revision"), 1);
    EXPECT_EQ(edit(id, dim, "\"0\", \"1\"").status, 200);
    EXPECT_EQ(edit(id, dim, "*").status, 200);
    EXPECT_EQ(job(id).at("revision"), 3);
}

TEST_F(EditRoutes, WhatCannotBeDoneIsSaidOfItsFieldAndChangesNothing) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0-2"})");
    const auto refused = [&](const std::string& edits, const std::string& place) {
        expect_problem(edit(id, edits), 422, "request#/edits/" + place);
    };
    refused(R"({"move":{"node":"nothing","translation":[0,0,0]}})", "0/move/node");
    refused(R"({"light":{"material":"x","emission_scale":1}})", "0/light/material");
    refused(R"({"light":{"lamp":"x","intensity_scale":1}})", "0/light/lamp");
    refused(R"({"light":{"lamp":"bulb","intensity":1e6}})", "0/light/intensity");
    refused(R"({"light":{"name":"x","scale":1}})", "0/light/name");
    refused(R"({"light":{"name":"lamp","scale":1}})", "0/light/name");
    refused(R"({"light":{"name":"off","scale":1}})", "0/light/scale");
    refused(R"({"material":{"material":"x","reflectance":0}})", "0/material/material");
    refused(R"({"camera":{"camera":"x"}})", "0/camera/camera");
    refused(R"({"path":{"node":"triangle","translation":[[0,0,0,0]]}})", "0/path/node");
    refused(R"({"add":{"node":"crate","geometry":{"box":{"size":[1,1,1]},"material":"x"}}})",
            "0/add/geometry/material");
    refused(R"({"add":{"node":"triangle","geometry":{"box":{"size":[1,1,1]},"material":"lamp"}}})", "0/add");
    // Edits of one request see what those before them have done.
    refused(std::string(R"({"remove":{"node":"triangle"}},)") + nudge, "1/move/node");
    expect_problem(ask("POST", "/v1/jobs/" + id + "/edits", "{", {{"if-match", "*"}}), 400, "request");
    expect_problem(
        ask("POST", "/v1/jobs/" + id + "/edits", "{}", {{"if-match", "*"}, {"content-type", "text/plain"}}),
        415, "Content-Type");
    const std::string long_body(std::size_t{2} << 20U, ' ');
    expect_problem(ask("POST", "/v1/jobs/" + id + "/edits", long_body, {{"if-match", "*"}}), 413, "request");
    std::string many = dim;
    for (int k = 0; k < 100; ++k) many += std::string(",") + dim;
    expect_problem(edit(id, many), 413, "request#/edits/100");
    expect_problem(edit("unknown", dim, "*"), 404, "unknown");
    EXPECT_EQ(job(id).at("revision"), 0);
    EXPECT_EQ(ask("POST", "/v1/jobs/" + id + "/cancel").status, 200);
    expect_problem(edit(id, dim), 409, id);
}

TEST_F(EditRoutes, AFinishedJobIsQueuedAgainAndKeepsItsPicturesUntilThereAreNewOnes) {
    const std::string id = submit(R"({"frames":"0-3"})");
    wait_for_end(id);
    solver_.close();
    const std::string old = "/v1/jobs/" + id + "/frames/2/image";
    const std::string before = ask("GET", old).body;
    ASSERT_EQ(edit(id, nudge).status, 200);
    EXPECT_TRUE(job(id).at("ended").is_null());
    EXPECT_THAT(stale_frames(id), ElementsAre(true, true, true, true));
    EXPECT_EQ(ask("GET", old).body, before);
    solver_.open();
    wait_for_end(id);
    EXPECT_EQ(job(id).at("reused"), 0) << "its state had been freed";
    EXPECT_THAT(solver_.edits(), ElementsAre());
    EXPECT_THAT(stale_frames(id), ElementsAre(false, false, false, false));
    EXPECT_EQ(solver_.steps().size(), 8U);
}

TEST_F(EditRoutes, APausedJobStaysPausedAndGoesOnWithItsEdits) {
    solver_.close_after(2);
    const std::string id = submit(R"({"frames":"0-20"})");
    wait_until([&] { return job(id).at("frames_done") == 2; });
    ASSERT_EQ(ask("POST", "/v1/jobs/" + id + "/pause").status, 200);
    ASSERT_EQ(edit(id, dim).status, 200);
    solver_.open();
    EXPECT_EQ(job(id).at("state"), "paused");
    EXPECT_EQ(job(id).at("frames_done"), 0);
    ASSERT_EQ(ask("POST", "/v1/jobs/" + id + "/resume").status, 200);
    wait_for_end(id);
    EXPECT_EQ(job(id).at("frames_done"), 21);
}

TEST_F(EditRoutes, EditsOutlastARestartWithThePicturesTheyMadeStale) {
    const std::string id = submit(R"({"frames":"0-9"})");
    wait_for_end(id);
    solver_.close();
    ASSERT_EQ(edit(id, dim).status, 200);
    ASSERT_EQ(edit(id, nudge).status, 200);
    ASSERT_EQ(ask("POST", "/v1/jobs/" + id + "/pause").status, 200);
    const Json edits = json("/v1/jobs/" + id + "/edits");
    restart();
    EXPECT_EQ(etag(id), "\"2\"");
    EXPECT_EQ(json("/v1/jobs/" + id + "/edits"), edits);
    EXPECT_EQ(edits.at("edits")[0].at("edits")[0].at("light").at("emission"), Json::array({0.5, 0.5, 0.5}));
    EXPECT_THAT(stale_frames(id), Each(true));
    EXPECT_EQ(job(id).at("stale_frames"), 10);
    ASSERT_EQ(ask("POST", "/v1/jobs/" + id + "/resume").status, 200);
    wait_for_end(id);
    EXPECT_THAT(stale_frames(id), Each(false));
    restart();
    EXPECT_THAT(stale_frames(id), Each(false));
    EXPECT_EQ(job(id).at("frames_done"), 10);
    EXPECT_EQ(json("/v1/jobs/" + id + "/frames").at("frames")[9].at("revision"), 2004);
}

TEST_F(EditRoutes, AFinalPicturesAddressNeverShowsAnother) {
    const std::string id = submit(R"({"frames":"0-1"})");
    wait_for_end(id);
    const Json frame = json("/v1/jobs/" + id + "/frames").at("frames")[0];
    const auto at = [&](const std::string& revision) {
        return service_->router().handle(
            {"GET", "/v1/jobs/" + id + "/frames/0/image", {{"rev", revision}}, {}, ""});
    };
    EXPECT_EQ(at("4").status, 200);
    ASSERT_EQ(edit(id, dim).status, 200);
    wait_for_end(id);
    EXPECT_EQ(at("4").status, 410);
    EXPECT_EQ(at("1004").status, 200);
    EXPECT_EQ(at("1005").status, 404);
}

TEST_F(EditRoutes, EditsThatComeAtAnyTimeAreAllTakenOver) {
    const std::string id = submit(R"({"frames":"0-40"})");
    for (int k = 0; k < 40; ++k) {
        ASSERT_EQ(edit(id, k % 2 == 0 ? dim : nudge).status, 200);
        std::this_thread::sleep_for(std::chrono::microseconds(500 * (k % 17)));
    }
    wait_for_end(id);
    EXPECT_EQ(job(id).at("revision"), 40);
    EXPECT_EQ(job(id).at("frames_done"), 41);
    const Json frames = json("/v1/jobs/" + id + "/frames");
    for (const Json& frame : frames.at("frames")) EXPECT_EQ(frame.at("job_revision"), 40);
    EXPECT_EQ(solver_.alive(), 0);
}

TEST_F(EditRoutes, WhatCanBeEditedIsToldAsItNowIs) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0-1"})");
    ASSERT_EQ(edit(id, std::string(dim) + "," + nudge).status, 200);
    const Json editable = json("/v1/jobs/" + id + "/editable");
    EXPECT_EQ(editable.at("revision"), 1);
    EXPECT_EQ(editable.at("objects")[0].at("node"), "triangle");
    EXPECT_EQ(editable.at("objects")[0].at("kind"), "furniture");
    EXPECT_NEAR(editable.at("objects")[0].at("low")[0].get<double>(), 0.1, 1e-6);
    EXPECT_EQ(editable.at("materials")[0].at("emission_scale"), 0.5);
    EXPECT_EQ(editable.at("cameras"), Json::array({"eye"}));
}

TEST_F(EditRoutes, ALampIsDimmedByItsName) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0-1"})");
    ASSERT_EQ(edit(id, R"({"light":{"name":"bulb","scale":0.5}})").status, 200);
    const Json kept = json("/v1/jobs/" + id + "/edits").at("edits")[0].at("edits")[0];
    EXPECT_EQ(kept,
              parse_json(R"({"light":{"lamp":"bulb","intensity_scale":0.5,"intensity":[2,1,0]}})", "edit"));
    const Json lamps = json("/v1/jobs/" + id + "/editable").at("lamps");
    ASSERT_EQ(lamps.size(), 3U);
    EXPECT_EQ(lamps[0].at("lamp"), "bulb");
    EXPECT_EQ(lamps[0].at("kind"), "point");
    EXPECT_EQ(lamps[0].at("intensity"), Json::array({2, 1, 0}));
    EXPECT_EQ(lamps[0].at("intensity_scale"), 0.5);
    EXPECT_EQ(lamps[1].at("intensity_scale"), 1);
    solver_.open();
    wait_for_end(id);
    EXPECT_EQ(job(id).at("frames_done"), 2);
}

TEST_F(EditRoutes, FramesPerSecondAreThoseAskedForElseTheScenes) {
    solver_.close();
    EXPECT_EQ(job(submit(R"({"frames":"0"})")).at("frames_per_second"), 10);
    const std::string asked = submit(R"({"frames":"0","fps":25})");
    restart();
    EXPECT_EQ(job(asked).at("frames_per_second"), 25);
}

}  // namespace
}  // namespace afterglow
