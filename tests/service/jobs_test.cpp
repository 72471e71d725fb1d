#include <csignal>
#include <set>

#include "tests/service/service_fixture.h"

namespace afterglow::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

bool has_line(const std::string& text) {
    return text.find('\n') != std::string::npos;
}

TEST_F(ServiceTest, TheFirstFrameComesCoarseThreeTimesBeforeItIsFinal) {
    // Enough lines for coarse solutions with far fewer.
    const std::string id = submit(
        "cornell-slide.glb", {"--frames", "0-2", "--size", "48x48", "--rays", "128", "--quality", "draft"});
    const Outcome watch = afterglow({"watch", id, "--json"});
    ASSERT_EQ(watch.exit, 0) << watch.err;
    EXPECT_EQ(json_lines(watch.out).back().at("event"), "end");

    int previous_id = 0;
    std::vector<client::Json> of_first_frame;
    std::set<int> final_frames;
    for (const auto& event : all_events(id)) {
        EXPECT_GT(event.at("id"), previous_id) << "ids must increase";
        previous_id = event.at("id");
        if (event.at("event") != "image") continue;
        const auto& image = event.at("data");
        if (image.at("frame") == 0) of_first_frame.push_back(image);
        if (image.at("final") == true) final_frames.insert(image.at("frame").get<int>());
    }
    EXPECT_THAT(final_frames, testing::ElementsAre(0, 1, 2));
    ASSERT_GE(of_first_frame.size(), 4U);
    for (std::size_t i = 0; i < of_first_frame.size(); ++i) {
        EXPECT_EQ(of_first_frame[i].at("revision"), i + 1);
        EXPECT_EQ(of_first_frame[i].at("final"), i + 1 == of_first_frame.size());
    }
    // Coarse pictures have matrices of their own, so only the final one is held to the asked error of 2 %.
    EXPECT_LE(of_first_frame.back().at("error_bound").get<double>(), 0.02);
}

TEST_F(ServiceTest, SubmitFollowsAndFetches) {
    const auto out = folder_.path() / "frames";
    std::vector<std::string> arguments{"submit", data_file("cornell-slide.glb"), "--out", out.string()};
    for (const auto& option : small("3-4")) arguments.push_back(option);
    const Outcome outcome = afterglow(arguments);
    ASSERT_EQ(outcome.exit, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("frames 3-4"));
    EXPECT_THAT(outcome.out, HasSubstr("frame 4 done (2 of 2)"));
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(out)) names.insert(entry.path().filename());
    EXPECT_THAT(names,
                testing::ElementsAre("frame_0003.exr", "frame_0003.png", "frame_0004.exr", "frame_0004.png"));
}

TEST_F(ServiceTest, GetFetchesOnceAndReplacesWhatIsCutOff) {
    const std::string id = submit("cornell-slide.glb", small("0-1"));
    ASSERT_EQ(afterglow({"watch", id}).exit, 0);
    const auto out = folder_.path() / "frames";
    const std::vector<std::string> get{"get", id, "-o", out.string(), "--type", "png"};
    EXPECT_THAT(afterglow(get).out, HasSubstr("2 files fetched, 0 already there"));
    EXPECT_FALSE(std::filesystem::exists(out / "frame_0000.exr"));
    const auto whole = std::filesystem::file_size(out / "frame_0001.png");
    std::filesystem::resize_file(out / "frame_0001.png", whole - 1);
    EXPECT_THAT(afterglow(get).out, HasSubstr("1 files fetched, 1 already there"));
    EXPECT_EQ(std::filesystem::file_size(out / "frame_0001.png"), whole);
}

TEST_F(ServiceTest, AKilledWatcherLeavesTheJobRunning) {
    const std::string id = submit("cornell-slide.glb", small("0-9"));
    const auto watcher = start_afterglow({"watch", id});
    ASSERT_TRUE(watcher->wait_for_output(has_line)) << watcher->err();
    watcher->send_signal(SIGKILL);
    watcher->wait();
    const Outcome again = afterglow({"watch", id});
    EXPECT_EQ(again.exit, 0) << again.err;
    EXPECT_EQ(job(id).at("state"), "succeeded");
    EXPECT_EQ(job(id).at("frames_done"), 10);
}

TEST_F(ServiceTest, ACancelledJobEndsItsWatchersAndFreesTheMachine) {
    const std::string id = submit("living-room.glb", endless());
    const auto watcher = start_afterglow({"watch", id});
    ASSERT_TRUE(watcher->wait_for_output(has_line)) << watcher->err();
    const Outcome cancel = afterglow({"cancel", id});
    EXPECT_EQ(cancel.exit, 0) << cancel.err;
    EXPECT_EQ(watcher->wait(), 3) << watcher->err();
    EXPECT_EQ(job(id).at("state"), "cancelled");
    EXPECT_EQ(afterglow({"cancel", id}).exit, 2) << "it has already ended";

    const std::string next = submit("cornell-slide.glb", small("0"));
    EXPECT_EQ(afterglow({"watch", next}).exit, 0);
}

TEST_F(ServiceTest, TwoJobsTakeTurns) {
    const std::string longer = submit("cornell-slide.glb", endless());
    const std::string shorter = submit("cornell-slide.glb", small("0-2"));
    // Without turns the short job would wait for thousands of frames.
    EXPECT_EQ(afterglow({"watch", shorter}).exit, 0);
    EXPECT_EQ(job(longer).at("state"), "running");
    EXPECT_EQ(afterglow({"cancel", longer}).exit, 0);

    const std::string first = submit("cornell-slide.glb", small("0-7"));
    const std::string second = submit("living-room.glb", small("0-7"));
    EXPECT_EQ(afterglow({"watch", first}).exit, 0);
    EXPECT_EQ(afterglow({"watch", second}).exit, 0);
}

TEST_F(ServiceTest, CtrlCDetachesAndSaysHowToComeBack) {
    const std::string id = submit("living-room.glb", endless());
    const auto watcher = start_afterglow({"watch", id});
    ASSERT_TRUE(watcher->wait_for_output(has_line)) << watcher->err();
    watcher->send_signal(SIGINT);
    EXPECT_EQ(watcher->wait(), 130);
    EXPECT_THAT(watcher->err(), HasSubstr("afterglow watch " + id));
    const std::string state = job(id).at("state");
    EXPECT_TRUE(state == "queued" || state == "running") << state;
    EXPECT_EQ(afterglow({"cancel", id}).exit, 0);
}

TEST_F(ServiceTest, ListsJobsNewestFirst) {
    const std::string first = submit("cornell-slide.glb", small("0"));
    const std::string second = submit("cornell-slide.glb", small("1"));
    const auto jobs = client::Json::parse(afterglow({"ls", "--json"}).out).at("jobs");
    ASSERT_EQ(jobs.size(), 2U);
    EXPECT_EQ(jobs[0].at("id"), second);
    EXPECT_EQ(jobs[1].at("id"), first);
    const std::string table = afterglow({"ls"}).out;
    EXPECT_LT(table.find(second), table.find(first));
    EXPECT_NE(table.find(first), std::string::npos);
}

TEST_F(ServiceTest, AnUnknownJobIsNotFound) {
    for (const std::string command : {"watch", "show", "cancel"}) {
        const Outcome outcome = afterglow({command, "no-such-job"});
        EXPECT_EQ(outcome.exit, 4) << command;
        EXPECT_THAT(outcome.err, StartsWith("afterglow: ")) << command;
    }
    const auto out = folder_.path() / "frames";
    EXPECT_EQ(afterglow({"get", "no-such-job", "-o", out.string()}).exit, 4);
    EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace afterglow::test
