#include "service/work/encoder.h"

#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/file.h"
#include "solver/base/pixels.h"
#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::Pair;

/// An encoder whose thread can be held, and what it told.
struct Bench {
    ScratchFolder folder;
    FrameStore frames{folder.path()};
    std::mutex mutex;
    std::vector<std::pair<int, int>> stored;  ///< frame, revision
    int failures = 0;
    Encoder encoder{frames,
                    {[this](const std::string&, const FrameInfo& info) {
                         const std::lock_guard lock(mutex);
                         stored.emplace_back(info.frame, info.revision);
                     },
                     [this](const std::string&, const std::exception_ptr&) {
                         const std::lock_guard lock(mutex);
                         ++failures;
                     }},
                    {.max_waiting = 3}};

    /// Keeps the encoder busy until the promise is fulfilled; returns once it is.
    std::promise<void> hold() {
        std::promise<void> release;
        auto held = std::make_shared<std::promise<void>>();
        encoder.after_pictures([held, released = release.get_future().share()] {
            held->set_value();
            released.wait();
        });
        held->get_future().wait();
        return release;
    }
    void wait_until_done() {
        std::promise<void> done;
        encoder.after_pictures([&] { done.set_value(); });
        done.get_future().wait();
    }
};

PictureTask task(int frame, int revision, PictureTask::Keep keep = PictureTask::Keep::until_superseded) {
    return {"job", fake_revision(frame, revision), std::nullopt, keep};
}

TEST(Encoder, ANewerRevisionReplacesAnOlderOneThatWaits) {
    Bench bench;
    auto release = bench.hold();
    for (const int revision : {1, 2, 3}) bench.encoder.submit(task(0, revision));
    bench.encoder.submit(task(1, 1));
    release.set_value();
    bench.wait_until_done();
    EXPECT_THAT(bench.stored, ElementsAre(Pair(0, 3), Pair(1, 1)));
}

TEST(Encoder, FinalPicturesAndThoseToKeepAreNeverReplaced) {
    Bench bench;
    auto release = bench.hold();
    bench.encoder.submit(task(0, 1, PictureTask::Keep::always));
    bench.encoder.submit(task(0, 2));
    bench.encoder.submit(task(0, 3));
    bench.encoder.submit(task(0, FakeSolver::revisions));
    bench.encoder.submit(task(1, 1));
    release.set_value();
    bench.wait_until_done();
    EXPECT_THAT(bench.stored, ElementsAre(Pair(0, 1), Pair(0, FakeSolver::revisions), Pair(1, 1)));
}

TEST(Encoder, WaitsRatherThanKeepingTooMany) {
    Bench bench;
    auto release = bench.hold();
    std::thread submitter([&] {
        for (int frame = 0; frame < 20; ++frame) bench.encoder.submit(task(frame, FakeSolver::revisions));
    });
    release.set_value();
    submitter.join();
    bench.wait_until_done();
    ASSERT_EQ(bench.stored.size(), 20U);
    for (int frame = 0; frame < 20; ++frame)
        EXPECT_EQ(bench.stored[static_cast<std::size_t>(frame)].first, frame);
}

TEST(Encoder, ForgetsAJob) {
    Bench bench;
    auto release = bench.hold();
    bench.encoder.submit(task(0, 1));
    bench.encoder.submit(task(0, FakeSolver::revisions));
    bench.encoder.forget("job");
    release.set_value();
    bench.wait_until_done();
    EXPECT_TRUE(bench.stored.empty());
}

TEST(Encoder, TellsAFailureAndGoesOn) {
    Bench bench;
    PictureTask broken = task(0, FakeSolver::revisions);
    write_file(bench.folder.path() / "taken", "a file where the job's folder should be");
    broken.job = "taken";
    bench.encoder.submit(std::move(broken));
    bench.encoder.submit(task(1, FakeSolver::revisions));
    bench.wait_until_done();
    EXPECT_EQ(bench.failures, 1);
    EXPECT_THAT(bench.stored, ElementsAre(Pair(1, FakeSolver::revisions)));
}

TEST(Encoder, StoresPicturesThatCanBeRead) {
    Bench bench;
    bench.encoder.submit(task(0, FakeSolver::revisions));
    bench.wait_until_done();
    const auto png = bench.frames.read("job", 0, FakeSolver::revisions, PictureType::png);
    ASSERT_TRUE(png.has_value());
    const Bytes8 picture = decode_picture(*png, "png");
    EXPECT_EQ(picture.width, 4);
    EXPECT_EQ(picture.height, 2);
    EXPECT_EQ(picture.rgba[0], FakeSolver::revisions * 20);
    const auto exr = bench.frames.read("job", 0, FakeSolver::revisions, PictureType::exr);
    ASSERT_TRUE(exr.has_value());
    EXPECT_EQ(exr->substr(0, 4), "\x76\x2f\x31\x01");
}

}  // namespace
}  // namespace afterglow
