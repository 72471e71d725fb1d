#include "client/watch_reporter.h"

#include <sstream>

#include <gmock/gmock.h>

namespace afterglow::client {
namespace {

using testing::HasSubstr;

struct Shown {
    std::ostringstream out;
    std::ostringstream err;
};

const std::vector<ServerEvent> story{
    {"snapshot", "", R"({"id":"j","state":"queued","first_frame":0,"last_frame":1,"frames":[]})"},
    {"job", "1", R"({"id":"j","state":"running","first_frame":0,"last_frame":1})"},
    {"progress", "2", R"({"frame":0,"progress":0.2,"doing":"light","remaining_s":4})"},
    {"image", "3", R"({"frame":0,"revision":1,"final":false,"residual":0.3})"},
    {"warning", "4", R"({"place":"sofa","message":"is glossy"})"},
    {"image", "5", R"({"frame":0,"revision":2,"final":true,"residual":0.01})"},
    {"end", "6", R"({"state":"succeeded"})"},
};

void tell(Shown& shown, OutputFormat format, std::function<int()> columns) {
    const auto reporter = make_reporter(format, {shown.out, shown.err, std::move(columns)});
    WatchView view;
    for (const ServerEvent& event : story) {
        const WatchNews news = apply_event(view, event, "job");
        reporter->on_event(event, view, news);
    }
    reporter->on_retry(std::chrono::milliseconds(250));
}

TEST(WatchReporter, WritesOneLineForEachFrameAndStateWhereThereIsNoTerminal) {
    Shown shown;
    tell(shown, OutputFormat::text, {});
    EXPECT_EQ(
        shown.out.str(),
        "queued, 2 frames\nrunning, 2 frames\nframe 0 done (1 of 2): revision 2, residual 1 %\nsucceeded\n");
    EXPECT_EQ(shown.err.str(), "warning: sofa: is glossy\nconnection lost, next attempt in 250 ms\n");
}

TEST(WatchReporter, WritesEveryEventAsOneLineOfJson) {
    Shown shown;
    tell(shown, OutputFormat::json, {});
    std::istringstream lines(shown.out.str());
    std::vector<Json> events;
    for (std::string line; std::getline(lines, line);) events.push_back(Json::parse(line));
    ASSERT_EQ(events.size(), story.size());
    for (std::size_t i = 0; i < story.size(); ++i) {
        EXPECT_EQ(events[i]["event"], story[i].name);
        EXPECT_EQ(events[i]["data"], Json::parse(story[i].data));
    }
    EXPECT_TRUE(events[0]["id"].is_null());
    EXPECT_EQ(events[6]["id"], 6);
    EXPECT_EQ(shown.err.str(), "warning: sofa: is glossy\nconnection lost, next attempt in 250 ms\n");
}

TEST(WatchReporter, RedrawsOneLineOnATerminal) {
    Shown shown;
    tell(shown, OutputFormat::text, [] { return 60; });
    const std::string text = shown.out.str();
    EXPECT_THAT(text, HasSubstr("\r["));
    EXPECT_THAT(text, HasSubstr("succeeded"));
    // The line makes way once for the warning and once for the lost connection; nothing else ends it.
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 0);
    EXPECT_EQ(shown.err.str(), "warning: sofa: is glossy\nconnection lost, next attempt in 250 ms\n");
}

TEST(WatchReporter, LeavesTheTerminalOnANewLine) {
    Shown shown;
    {
        const auto reporter = make_reporter(OutputFormat::text, {shown.out, shown.err, [] { return 60; }});
        WatchView view;
        const WatchNews news = apply_event(view, story[0], "job");
        reporter->on_event(story[0], view, news);
    }
    EXPECT_TRUE(shown.out.str().ends_with("\n"));
}

TEST(WatchReporter, SaysWhenItsOutputIsGone) {
    Shown shown;
    shown.out.setstate(std::ios::badbit);
    EXPECT_THROW(tell(shown, OutputFormat::text, {}), ClientError);
    EXPECT_THROW(tell(shown, OutputFormat::json, {}), ClientError);
}

}  // namespace
}  // namespace afterglow::client
