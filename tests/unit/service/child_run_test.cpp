#include "service/work/child_run.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <stop_token>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/work/worker_message.h"
#include "solver/base/file.h"
#include "tests/unit/service/fake_solver.h"
#include "tests/unit/service/sanitized.h"

namespace afterglow {
namespace {

class ChildRunTest : public testing::Test {
  protected:
    ChildRunTest() {
        job_.scene = scenes_
                         .add(read_file(AFTERGLOW_TEST_DATA "/cornell-slide.glb"),
                              {SceneFormat::glb, "cornell-slide.glb", {}})
                         .scene.id;
        job_.frames = {0, 2};
        SequenceConfig& config = job_.settings.sequence;
        config.width = 40, config.height = 30;
        config.quality = Quality::draft;
        config.rays_per_patch = 32;
    }
    RunFactory children() const {
        return child_runs(scenes_, {folder_.path() / "cache", {}, AFTERGLOW_BIN_DIR "/afterglowd"});
    }
    std::unique_ptr<JobRun> run_here() const {
        return solver_run(job_, read_world(scenes_.source(job_.scene, "", {}), usual_reader()),
                          folder_.path() / "cache", Context(1));
    }
    /// The processes that this one has started and not yet taken leave of.
    static std::vector<pid_t> own_children() {
        std::vector<pid_t> pids;
        for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
            std::ifstream in(task.path() / "children");
            for (pid_t pid = 0; in >> pid;) pids.push_back(pid);
        }
        return pids;
    }

    ScratchFolder folder_;
    SceneStore scenes_{folder_.path() / "uploads", surveys_here(usual_reader())};
    Job job_;
};

TEST_F(ChildRunTest, GivesTheSameBitsAsARunHere) {
    const auto here = run_here();
    const auto there = children()(job_, Context(2), {});
    for (int frame = 0; frame < 3; ++frame) {
        std::vector<Revision> expected;
        std::vector<Revision> found;
        double reached = 0;
        std::string doing;
        const Context telling(2, {}, [&](const Progress& progress) {
            reached = progress.fraction;
            doing = progress.doing;
        });
        const auto a = here->step(
            frame, [&](const Revision& r) { expected.push_back(r); }, Context(1));
        const auto b = there->step(
            frame, [&](const Revision& r) { found.push_back(r); }, telling);
        EXPECT_EQ(b.frame, frame);
        EXPECT_EQ(b.error_bound, a.error_bound);
        EXPECT_EQ(b.shots, a.shots);
        EXPECT_GT(reached, 0);
        EXPECT_FALSE(doing.empty());
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].revision, expected[i].revision);
            EXPECT_EQ(found[i].final, expected[i].final);
            EXPECT_EQ(found[i].residual, expected[i].residual);
            EXPECT_EQ(found[i].radiance.pixels, expected[i].radiance.pixels);
            EXPECT_EQ(found[i].srgb, expected[i].srgb);
        }
    }
    EXPECT_EQ(there->statistics().patches, here->statistics().patches);
    EXPECT_EQ(there->statistics().method, here->statistics().method);
    EXPECT_EQ(there->warnings().size(), here->warnings().size());
}

TEST_F(ChildRunTest, AWatchedRunBeginsWithASketchOfItsFirstFrame) {
    const auto run = run_here();
    for (const int frame : {1, 2}) {
        std::vector<Revision> shown;
        run->step(
            frame, [&](const Revision& r) { shown.push_back(r); }, Context(2));
        for (std::size_t k = 0; k < shown.size(); ++k) {
            EXPECT_EQ(shown[k].revision, static_cast<int>(k) + 1);
            EXPECT_EQ(shown[k].frame, frame);
            EXPECT_EQ(shown[k].final, k + 1 == shown.size());
        }
        // Sketch, few lines, more, all; later frames follow at once.
        EXPECT_EQ(shown.size(), frame == 1 ? 5U : 1U);
    }
    job_.settings.sequence.revisions = Revisions::final_only;
    int shown = 0;
    run_here()->step(
        0, [&](const Revision&) { ++shown; }, Context(2));
    EXPECT_EQ(shown, 1);
}

TEST_F(ChildRunTest, ARunStoppedBeforeItHasPatchesCanGoOn) {
    const auto stopped = run_here(), other = run_here();
    std::stop_source stop;
    int shown = 0;
    EXPECT_THROW(stopped->step(
                     0,
                     [&](const Revision&) {
                         ++shown;
                         stop.request_stop();
                     },
                     Context(2, stop.get_token())),
                 Error);
    EXPECT_EQ(shown, 1);
    const auto final_picture = [](JobRun& run) {
        Picture last;
        run.step(
            0, [&](const Revision& r) { last = r.radiance; }, Context(2));
        return last.pixels;
    };
    EXPECT_EQ(final_picture(*stopped), final_picture(*other));
}

TEST_F(ChildRunTest, ErrorsKeepTheirTypes) {
    job_.settings.sequence.camera = "nobody's";
    try {
        children()(job_, Context(1), {});
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::not_found);
    }
}

TEST_F(ChildRunTest, ADeathNamesItsSignal) {
    const auto run = children()(job_, Context(1), {});
    const auto pids = own_children();
    ASSERT_EQ(pids.size(), 1U);
    ::kill(pids[0], SIGABRT);
    try {
        run->step(
            0, [](const Revision&) {}, Context(1));
        FAIL() << "it went on";
    } catch (const ChildDied& e) {
        EXPECT_STREQ(e.what(), "its computation ended with signal 6 (ABRT)");
        EXPECT_EQ(e.cause(), ChildDied::Cause::ended);
    }
}

TEST_F(ChildRunTest, AProcessThatMayTakeNoMoreMemorySaysSo) {
    if (takes_all_address_space) return;
    // Wherever it runs out: while it begins, or later.
    for (const std::uint64_t megabytes : {1, 8, 16, 32, 48, 64}) {
        const ChildLimits limits{megabytes << 20U, {}};
        const auto limited =
            child_runs(scenes_, {folder_.path() / "cache", limits, AFTERGLOW_BIN_DIR "/afterglowd"});
        try {
            const auto run = limited(job_, Context(2), {});
            run->step(
                0, [](const Revision&) {}, Context(2));
            EXPECT_GT(megabytes, 1U);
        } catch (const ChildDied& e) {
            EXPECT_EQ(e.cause(), ChildDied::Cause::memory) << megabytes << " MiB: " << e.what();
        }
        EXPECT_TRUE(own_children().empty());
    }
}

TEST_F(ChildRunTest, AnAbandonedRunEndsItsProcessAlsoBetweenItsSteps) {
    std::stop_source stop;
    const auto run = children()(job_, Context(1), stop.get_token());
    ASSERT_EQ(own_children().size(), 1U);
    stop.request_stop();
    try {
        run->step(
            0, [](const Revision&) {}, Context(1, stop.get_token()));
        FAIL() << "it went on";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::cancelled);
    }
    EXPECT_TRUE(own_children().empty());
}

TEST_F(ChildRunTest, AStoppedStepLeavesTheRunUsable) {
    const auto here = run_here();
    const auto there = children()(job_, Context(1), {});
    // Stopped before, while it works at each frame, and after.
    std::stop_source before;
    before.request_stop();
    EXPECT_THROW(there->step(
                     0, [](const Revision&) {}, Context(1, before.get_token())),
                 Error);
    for (int frame = 0; frame < 3; ++frame) {
        std::stop_source stop;
        const auto stop_at_once = [&](const Revision&) { stop.request_stop(); };
        try {
            there->step(frame, stop_at_once, Context(1, stop.get_token()));
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::cancelled);
        }
        stop.request_stop();
    }
    Picture expected;
    Picture found;
    here->step(
        0, [&](const Revision& r) { expected = r.radiance; }, Context(1));
    there->step(
        0, [&](const Revision& r) { found = r.radiance; }, Context(1));
    ASSERT_EQ(found.pixels.size(), expected.pixels.size());
    EXPECT_GT(found.pixels.size(), 0U);
}

TEST(WorkerMessage, WhatIsWrongCountsAsClosed) {
    Revision revision = fake_revision(3, 4);
    Message message = message_of(revision);
    EXPECT_EQ(revision_of(message).radiance.pixels, revision.radiance.pixels);
    message.bytes.pop_back();
    EXPECT_THROW(revision_of(message), ChannelClosed);
    message = message_of(revision);
    message.values["width"] = 1'000'000;
    EXPECT_THROW(revision_of(message), ChannelClosed);
    message.values.erase("width");
    EXPECT_THROW(revision_of(message), ChannelClosed);
    EXPECT_THROW(done_of({MessageKind::done, Json::object(), "short"}), ChannelClosed);
    EXPECT_THROW(start_of({MessageKind::start, Json::object()}), ChannelClosed);
}

}  // namespace
}  // namespace afterglow
