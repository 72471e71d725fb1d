#include "client/watch_view.h"

#include <gmock/gmock.h>

namespace afterglow::client {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = WatchNews::Kind;

constexpr const char* running =
    R"({"id":"j","state":"running","first_frame":0,"last_frame":3,"progress":0.5,"doing":"light","remaining_s":9})";

TEST(WatchView, FollowsAJobFromQueuedToItsEnd) {
    WatchView view;
    const auto apply = [&](const char* name, const char* data) {
        return apply_event(view, {name, "1", data}, "job");
    };
    EXPECT_EQ(
        apply("snapshot", R"({"id":"j","state":"queued","first_frame":0,"last_frame":3,"frames":[]})").kind,
        Kind::state);
    EXPECT_EQ(apply("job", running).kind, Kind::state);
    EXPECT_EQ(view.state, JobState::running);
    EXPECT_EQ(view.remaining_s, 9);
    EXPECT_EQ(apply("progress", R"({"frame":0,"progress":0.1,"doing":"rays","remaining_s":null})").kind,
              Kind::progress);
    EXPECT_EQ(view.doing, "rays");
    EXPECT_EQ(view.remaining_s, std::nullopt);
    EXPECT_EQ(apply("image", R"({"frame":0,"revision":1,"final":false})").kind, Kind::image);
    EXPECT_EQ(apply("image", R"({"frame":0,"revision":2,"final":true})").kind, Kind::final_image);
    EXPECT_THAT(view.finished, ElementsAre(0));
    EXPECT_EQ(apply("end", R"({"state":"succeeded"})").kind, Kind::state);
    EXPECT_EQ(view.state, JobState::succeeded);
}

TEST(WatchView, TakesFinishedFramesFromASnapshot) {
    WatchView view;
    apply_event(view,
                {"snapshot", "9",
                 R"({"id":"j","state":"running","first_frame":0,"last_frame":3,"frames":[
                    {"frame":0,"revision":4,"final":true},{"frame":1,"revision":2,"final":false}]})"},
                "job");
    EXPECT_THAT(view.finished, ElementsAre(0));
    EXPECT_EQ(view.current_frame, 1);
    EXPECT_EQ(view.image->revision, 2);
}

TEST(WatchView, AnEditLetsFramesFinishAgain) {
    WatchView view;
    const auto apply = [&](const char* name, const char* data) {
        return apply_event(view, {name, "1", data}, "job");
    };
    apply("job", running);
    for (const char* image :
         {R"({"frame":0,"revision":4,"final":true})", R"({"frame":1,"revision":4,"final":true})"})
        EXPECT_EQ(apply("image", image).kind, Kind::final_image);
    const WatchNews edited = apply("edit", R"({"revision":1,"first_frame":1,"reused":null,"edits":[]})");
    EXPECT_EQ(edited.kind, Kind::edit);
    EXPECT_EQ(edited.told, "edited: frames from 1 on are computed again");
    EXPECT_THAT(view.finished, ElementsAre(0));
    EXPECT_EQ(apply("reused", R"({"revision":1,"reused":0.5})").told, "the edit kept 50 % of all lines");
    EXPECT_EQ(apply("image", R"({"frame":1,"revision":5,"final":true,"stale":true})").kind, Kind::nothing);
    EXPECT_EQ(apply("image", R"({"frame":1,"revision":1004,"final":true,"stale":false})").kind,
              Kind::final_image);
    EXPECT_THAT(view.finished, ElementsAre(0, 1));
}

TEST(WatchView, ARepeatedPictureOrStateIsNoNews) {
    WatchView view;
    const ServerEvent job{"job", "2", running};
    const ServerEvent second{"image", "4", R"({"frame":0,"revision":2,"final":false})"};
    const ServerEvent first{"image", "3", R"({"frame":0,"revision":1,"final":false})"};
    const ServerEvent last{"image", "5", R"({"frame":0,"revision":3,"final":true})"};
    EXPECT_EQ(apply_event(view, job, "job").kind, Kind::state);
    EXPECT_EQ(apply_event(view, job, "job").kind, Kind::nothing);
    EXPECT_EQ(apply_event(view, second, "job").kind, Kind::image);
    EXPECT_EQ(apply_event(view, first, "job").kind, Kind::nothing);
    EXPECT_EQ(apply_event(view, last, "job").kind, Kind::final_image);
    EXPECT_EQ(apply_event(view, last, "job").kind, Kind::nothing);
    EXPECT_EQ(apply_event(view, first, "job").kind, Kind::nothing);
}

TEST(WatchView, TellsEachWarningOnce) {
    WatchView view;
    view.warned = {"old: told"};
    const auto from_job = apply_event(
        view,
        {"job", "1",
         R"({"id":"j","state":"running","warnings":[{"place":"old","message":"told"},{"place":"a","message":"b"}]})"},
        "job");
    EXPECT_THAT(from_job.warnings, ElementsAre("a: b"));
    EXPECT_THAT(apply_event(view, {"warning", "2", R"({"place":"a","message":"b"})"}, "job").warnings,
                IsEmpty());
    EXPECT_THAT(apply_event(view, {"warning", "3", R"({"place":"","message":"c"})"}, "job").warnings,
                ElementsAre("c"));
}

TEST(WatchView, RemembersWhyAJobFailed) {
    WatchView by_event;
    apply_event(by_event, {"error", "1", R"({"detail":"no light","place":"scene"})"}, "job");
    EXPECT_EQ(by_event.error, "scene: no light");
    WatchView by_snapshot;
    apply_event(by_snapshot,
                {"snapshot", "1", R"({"id":"j","state":"failed","error":{"detail":"no light"}})"}, "job");
    EXPECT_EQ(by_snapshot.error, "no light");
}

TEST(WatchView, PassesOverEventsOfANewerServer) {
    WatchView view;
    EXPECT_EQ(apply_event(view, {"brightness", "1", "{}"}, "job").kind, Kind::nothing);
    EXPECT_EQ(apply_event(view, {"progress", "1", "[1]"}, "job").kind, Kind::progress);
}

TEST(WatchView, RefusesDataThatCannotBeUnderstood) {
    WatchView view;
    for (const ServerEvent& event : {ServerEvent{"job", "1", "{"}, ServerEvent{"job", "1", "{}"},
                                     ServerEvent{"image", "1", "{}"}, ServerEvent{"end", "1", "{}"}}) {
        try {
            apply_event(view, event, "job j");
            ADD_FAILURE() << event.data;
        } catch (const ClientError& error) {
            EXPECT_EQ(error.code(), ExitCode::no_server);
            EXPECT_TRUE(std::string(error.what()).starts_with("job j: ")) << error.what();
        }
    }
}

}  // namespace
}  // namespace afterglow::client
