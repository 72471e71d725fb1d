#include <algorithm>
#include <csignal>
#include <fstream>
#include <thread>

#include "tests/service/service_fixture.h"
#include "tests/support/picture_error.h"

namespace afterglow::test {
namespace {

using testing::HasSubstr;

/// Jobs that are edited on the way, by the real programs.
class Edits : public ServiceTest {
  protected:
    /// A room with a lamp, a crate, a robot that moves and, where it has any intensity, a bulb without
    /// surface. What the arguments say could also be edited.
    std::string room(double emission, double crate_x, double crate_reflectance, double bulb = 0) {
        const auto node = [](const char* name, std::vector<double> place, client::Json geometry) {
            return client::Json{{"name", name}, {"translation", place}, {"geometry", std::move(geometry)}};
        };
        const auto box = [](std::vector<double> size, const char* material) {
            return client::Json{{"box", {{"size", size}}}, {"material", material}};
        };
        client::Json lamp = node("panel", {2, 2.9, 2}, {{"quad", {{"size", {1, 1}}}}, {"material", "lamp"}});
        lamp["rotation"] = {1, 0, 0, 180};
        client::Json scene = {
            {"afterglow", 1},
            {"materials",
             {{{"name", "wall"}, {"reflectance", 0.6}},
              {{"name", "lamp"}, {"reflectance", 0}, {"emission", {emission, emission, emission}}},
              {{"name", "wood"}, {"reflectance", crate_reflectance}}}},
            {"nodes",
             {node("room", {2, 1.5, 2}, box({4, 3, 4}, "wall")), lamp,
              node("crate", {crate_x, 0.5, 1}, box({0.75, 0.75, 0.75}, "wood")),
              node("robot", {1, 0.75, 3}, box({0.25, 0.5, 0.25}, "wood"))}},
            {"cameras", {{{"name", "camera"}, {"position", {3.5, 1.5, 3.5}}, {"look_at", {1, 0.75, 1}}}}},
            {"tracks", {{{"node", "robot"}, {"translation", {{0, 1, 0.75, 3}, {2, 3, 0.75, 3}}}}}}};
        if (bulb > 0)
            scene["lights"] = client::Json::array({client::Json{{"name", "bulb"},
                                                                {"kind", "point"},
                                                                {"position", {1, 2, 1}},
                                                                {"intensity", {bulb, bulb, 0}}}});
        const auto file = folder_.path() / ("room" + std::to_string(++rooms_) + ".json");
        std::ofstream(file) << scene.dump();
        return file.string();
    }
    std::string submit_room(const std::string& file, const std::string& frames) {
        const Outcome outcome =
            afterglow({"submit", "--json", file, "--frames", frames, "--size", "48x32", "--rays", "32",
                       "--patch-size", "0.4", "--error", "0.001", "--exposure", "0", "--quality", "final"});
        EXPECT_EQ(outcome.exit, 0) << outcome.err;
        return client::Json::parse(outcome.out).at("id").get<std::string>();
    }
    void edit(const std::vector<std::string>& arguments) {
        std::vector<std::string> all{"edit"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const Outcome outcome = afterglow(all);
        EXPECT_EQ(outcome.exit, 0) << outcome.err;
    }
    /// A job with more frames than any test waits for, so that it surely runs when it is edited.
    std::string submit_long(const std::string& file) { return submit_room(file, "0-50000"); }
    /// Waits for so many frames that show the job as it is, and stops there.
    void finish(const std::string& id, int frames) {
        wait_for_frames(id, frames);
        EXPECT_EQ(afterglow({"cancel", id}).exit, 0);
    }
    void kill_and_restart() {
        server_->send_signal(SIGKILL);
        server_->wait();
        start_server();
    }
    void wait_for_frames(const std::string& id, int count) {
        while (job(id).at("frames_done") < count) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    Picture picture(const std::string& id, int frame) {
        const auto reply = client::Json::parse(http_->get("/v1/jobs/" + id + "/frames").body);
        for (const auto& one : reply.at("frames")) {
            if (one.at("frame") != frame) continue;
            EXPECT_FALSE(one.at("stale").get<bool>()) << frame;
            const auto file = folder_.path() / "picture.exr";
            std::ofstream(file, std::ios::binary) << http_->get(one.at("exr").get<std::string>()).body;
            return read_picture(file);
        }
        ADD_FAILURE() << "no frame " << frame;
        return {};
    }
    /// Largest difference of two jobs' pictures of a frame, relative to the mean.
    double difference(const std::string& a, const std::string& b, int frame) {
        const Picture first = picture(a, frame), second = picture(b, frame);
        EXPECT_EQ(first.pixels.size(), second.pixels.size());
        double largest = 0, sum = 0;
        for (std::size_t k = 0; k < first.pixels.size(); ++k) {
            const auto apart = glm::abs(first.pixels[k] - second.pixels[k]);
            largest = std::max<double>(largest, std::max({apart.r, apart.g, apart.b}));
            sum += static_cast<double>(second.pixels[k].g);
        }
        return largest * static_cast<double>(first.pixels.size()) / sum;
    }
    client::HttpReply post_edit(const std::string& id, const std::string& edit, const std::string& tag) {
        return http_->post("/v1/jobs/" + id + "/edits", R"({"edits":[)" + edit + "]}", "application/json",
                           {{"If-Match", tag}});
    }

    int rooms_ = 0;
};

TEST_F(Edits, ARunningJobShowsWhatANewJobOnTheEditedSceneShows) {
    const std::string edited = submit_long(room(2, 1, 0.5));
    wait_for_frames(edited, 3);
    edit({"light", edited, "lamp", "--scale", "0.5"});
    edit({"material", edited, "wood", "--reflectance", "0.125,0.125,0.125"});
    finish(edited, 31);
    EXPECT_EQ(job(edited).at("reused"), 1) << "no line is traced again";
    const std::string fresh = submit_room(room(1, 1, 0.125), "0-30");
    ASSERT_EQ(afterglow({"watch", fresh}).exit, 0);
    // Both within their certificates and what final pictures keep of light that changed, .1 % each.
    for (const int frame : {0, 2, 3, 30}) EXPECT_LE(difference(edited, fresh, frame), 4e-3) << frame;

    bool told = false;
    for (const auto& event : all_events(edited)) told = told || event.at("event") == "reused";
    EXPECT_TRUE(told);
}

TEST_F(Edits, ALampWithoutSurfaceIsDimmedWhileTheJobRuns) {
    const std::string edited = submit_long(room(2, 1, 0.5, 4));
    wait_for_frames(edited, 3);
    edit({"light", edited, "bulb", "--scale", "0.25"});
    finish(edited, 4);
    EXPECT_EQ(job(edited).at("reused"), 1) << "no line is traced again";
    EXPECT_THAT(afterglow({"edit", "show", edited}).out,
                HasSubstr("lamp      bulb (point) shines 1.0,1.0,0.0 (25 %)"));
    const std::string fresh = submit_room(room(2, 1, 0.5, 1), "0-3");
    ASSERT_EQ(afterglow({"watch", fresh}).exit, 0);
    for (const int frame : {0, 3}) EXPECT_LE(difference(edited, fresh, frame), 4e-3) << frame;
}

TEST_F(Edits, FurnitureMovedWhileTheJobRunsStandsWhereANewJobHasIt) {
    const std::string edited = submit_long(room(2, 1, 0.5));
    wait_for_frames(edited, 2);
    edit({"move", edited, "crate", "--by", "1.5,0,0"});
    finish(edited, 13);
    const double reused = job(edited).at("reused");
    EXPECT_GT(reused, 0.3);
    EXPECT_LT(reused, 1);
    const std::string fresh = submit_room(room(2, 2.5, 0.5), "0-12");
    const std::string other = submit_room(room(2, 1, 0.5), "0-12");
    ASSERT_EQ(afterglow({"watch", fresh}).exit, 0);
    ASSERT_EQ(afterglow({"watch", other}).exit, 0);
    for (const int frame : {0, 12}) {
        // New patches have other lines, so their noise differs.
        EXPECT_LE(difference(edited, fresh, frame), 0.5 * difference(edited, other, frame)) << frame;
    }
}

TEST_F(Edits, OutlastAKillToTheBitOfANewJob) {
    const std::string edited = submit_long(room(2, 1, 0.5));
    wait_for_frames(edited, 2);
    ASSERT_EQ(afterglow({"pause", edited}).exit, 0);
    edit({"light", edited, "lamp", "--scale", "0.5"});
    edit({"move", edited, "crate", "--by", "1.5,0,0"});
    kill_and_restart();
    EXPECT_EQ(job(edited).at("revision"), 2);
    EXPECT_EQ(job(edited).at("frames_done"), 0);
    ASSERT_EQ(afterglow({"resume", edited}).exit, 0);
    finish(edited, 101);
    const std::string fresh = submit_long(room(1, 2.5, 0.5));
    finish(fresh, 101);
    for (const int frame : {0, 12, 100}) EXPECT_EQ(difference(edited, fresh, frame), 0) << frame;
}

TEST_F(Edits, OfARunningJobThatIsKilledAreNotLost) {
    const std::string edited = submit_long(room(2, 1, 0.5));
    wait_for_frames(edited, 2);
    edit({"light", edited, "lamp", "--scale", "0.5"});
    wait_for_frames(edited, 2);
    kill_and_restart();
    EXPECT_EQ(job(edited).at("revision"), 1);
    finish(edited, job(edited).at("frames_done").get<int>() + 20);
    const int last = job(edited).at("frames_done").get<int>() - 1;
    const std::string fresh = submit_room(room(1, 1, 0.5), "0-" + std::to_string(last));
    ASSERT_EQ(afterglow({"watch", fresh}).exit, 0);
    for (const int frame : {0, 1, last / 2, last}) EXPECT_LE(difference(edited, fresh, frame), 4e-3) << frame;
}

TEST_F(Edits, AnActorsNewWayLeavesEarlierFramesAlone) {
    const std::string id = submit_room(room(2, 1, 0.5), "0-23");
    wait_for_frames(id, 3);
    const auto file = folder_.path() / "keys.json";
    std::ofstream(file) << R"({"translation":[[0.5,1.5,0.75,3],[1,1.5,0.75,1.5]]})";
    edit({"path", id, "robot", file.string(), "--from", "0.5"});
    ASSERT_EQ(afterglow({"watch", id}).exit, 0);
    int again = 0;
    const auto frames = client::Json::parse(http_->get("/v1/jobs/" + id + "/frames").body).at("frames");
    for (const auto& frame : frames) {
        EXPECT_FALSE(frame.at("stale").get<bool>());
        if (frame.at("job_revision") == 0) {
            EXPECT_LT(frame.at("frame"), 12);
        }
        again += frame.at("frame") < 12 && frame.at("job_revision") == 1 ? 1 : 0;
    }
    EXPECT_LE(again, 9) << "the first three stay";
}

TEST_F(Edits, FurnitureIsAddedAndTakenAwayByName) {
    const std::string id = submit_room(room(2, 1, 0.5), "0-2");
    const auto file = folder_.path() / "shelf.json";
    std::ofstream(file) << R"({"box":{"size":[0.5,0.5,0.5]},"material":"wood"})";
    edit({"add", id, "shelf", file.string(), "--at", "1.5,0.5,1.5", "--turn", "45"});
    EXPECT_THAT(afterglow({"edit", "show", id}).out, HasSubstr("object    shelf (furniture) from "));
    edit({"remove", id, "shelf"});
    EXPECT_EQ(afterglow({"watch", id}).exit, 0);
    std::ofstream(file) << "[";
    const Outcome outcome = afterglow({"edit", "add", id, "shelf", file.string()});
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_THAT(outcome.err, HasSubstr("shelf.json: is no JSON"));
    std::ofstream(file) << R"({"moves":[]})";
    EXPECT_THAT(afterglow({"edit", "path", id, "robot", file.string()}).err,
                HasSubstr("expected translation and rotation, found \"moves\""));
}

TEST_F(Edits, AreRefusedWhereTheJobHasAnotherRevision) {
    const std::string id = submit("cornell-slide.glb", endless());
    const std::string dim = R"({"light":{"material":"lamp","emission_scale":0.5}})";
    EXPECT_EQ(post_edit(id, dim, "\"0\"").status, 200);
    const auto stale = post_edit(id, dim, "\"0\"");
    EXPECT_EQ(stale.status, 412) << stale.body;
    EXPECT_EQ(stale.header("Content-Type"), "application/problem+json");
    EXPECT_EQ(http_->post("/v1/jobs/" + id + "/edits", "{}", "application/json").status, 428);
    const auto bad = post_edit(id, dim + R"(,{"move":{"node":"sofa","translation":[0,0,1]}})", "\"1\"");
    EXPECT_EQ(bad.status, 422);
    EXPECT_THAT(bad.body, HasSubstr("request#/edits/1/move/node"));
    EXPECT_THAT(bad.body, HasSubstr("tall_block"));
    EXPECT_EQ(job(id).at("revision"), 1);

    const Outcome outcome = afterglow({"edit", "move", id, "sofa", "--by", "0,0,1"});
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_THAT(outcome.err, HasSubstr("request#/edits/0/move/node: there is no object \"sofa\""));
    EXPECT_THAT(afterglow({"edit", "show", id}).out, HasSubstr("object    tall_block (furniture) from "));
    EXPECT_EQ(afterglow({"cancel", id}).exit, 0);
    EXPECT_EQ(post_edit(id, dim, "\"1\"").status, 409);
    EXPECT_EQ(afterglow({"edit", "show", "no-such-job"}).exit, 4);
}

TEST_F(Edits, APausedJobTakesThemWhenItGoesOn) {
    const std::string id = submit_long(room(2, 1, 0.5));
    wait_for_frames(id, 2);
    ASSERT_EQ(afterglow({"pause", id}).exit, 0);
    const Outcome outcome =
        afterglow({"edit", "camera", id, "--position", "3.5,1,1", "--look-at=1,1,1", "--json"});
    ASSERT_EQ(outcome.exit, 0) << outcome.err;
    EXPECT_EQ(client::Json::parse(outcome.out).at("state"), "paused");
    EXPECT_EQ(job(id).at("frames_done"), 0);
    EXPECT_GE(job(id).at("stale_frames"), 2);
    ASSERT_EQ(afterglow({"resume", id}).exit, 0);
    finish(id, 5);
    const std::string before = submit_room(room(2, 1, 0.5), "0-2");
    ASSERT_EQ(afterglow({"watch", before}).exit, 0);
    EXPECT_GT(difference(id, before, 2), 0.2) << "it is another view";
}

TEST_F(Edits, WatchersHearOfThemAndFetchPicturesAnew) {
    const std::string id = submit("cornell-slide.glb", small("0-3"));
    ASSERT_EQ(afterglow({"watch", id}).exit, 0);
    const auto out = folder_.path() / "frames";
    const std::vector<std::string> get{"get", id, "-o", out.string()};
    ASSERT_EQ(afterglow(get).exit, 0);
    edit({"light", id, "lamp", "--scale", "0.25"});
    const Outcome watch = afterglow({"watch", id});
    EXPECT_EQ(watch.exit, 0) << watch.err;
    EXPECT_THAT(afterglow(get).out, HasSubstr("8 files fetched, 0 already there"));
    EXPECT_EQ(job(id).at("frames_per_second"), 24);
    std::string told;
    for (const auto& event : all_events(id)) told += event.at("event").get<std::string>() + " ";
    EXPECT_THAT(told, HasSubstr("edit "));
}

}  // namespace
}  // namespace afterglow::test
