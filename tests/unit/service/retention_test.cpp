#include "service/store/retention.h"

#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/base/identity.h"
#include "service/store/database.h"
#include "solver/base/file.h"
#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

using std::chrono::hours;

/// Stores in a folder, and a clock that is set by hand.
class RetentionTest : public testing::Test {
  protected:
    /// A job with pictures of so many bytes, two frames of them.
    std::string job_with(std::size_t bytes, JobState state = JobState::succeeded) {
        Job draft;
        draft.frames = {0, 1};
        const std::string id = jobs_.add(draft).id;
        jobs_.start(id);
        for (const int frame : {0, 1}) {
            const FrameInfo info{frame, 1, true, 0.1, 0.2, {}};
            frames_.put(id, info, {std::string(bytes / 4, 'p'), std::string(bytes / 4, 'e')});
            jobs_.note_picture(id, info);
        }
        frames_.flush();
        if (has_ended(state)) jobs_.end(id, state);
        return id;
    }
    void tidy(const RetentionConfig& config, hours later = hours(0)) {
        const auto now = [later] { return std::chrono::system_clock::now() + later; };
        Retention(jobs_, frames_, scenes_, blobs_, folder_.path() / "cache", config, now).tidy();
    }
    bool has_frames(const std::string& id) const {
        const bool told = !jobs_.find(id)->frames_removed;
        EXPECT_EQ(frames_.newest(id).size(), told ? 2U : 0U);
        EXPECT_EQ(frames_.bytes_of(id) > 0, told);
        EXPECT_EQ(jobs_.find(id)->frames_done, told ? 2 : 0);
        return told;
    }

    ScratchFolder folder_;
    Database database_{folder_.path() / "service.db"};
    JobTable table_{database_};
    JobStore jobs_{{}, &table_};
    FrameJournal journal_{database_, [](const FrameJournal::Entry&, const std::exception_ptr&) {}};
    FrameStore frames_{folder_.path() / "jobs", &journal_};
    SceneStore scenes_{folder_.path() / "uploads", surveys_here(fake_scene), &database_};
    BlobStore blobs_{folder_.path() / "blobs", 1 << 20};
};

TEST_F(RetentionTest, OldPicturesGoAndTheirJobsSaySo) {
    const std::string ended = job_with(1000);
    const std::string failed = job_with(1000, JobState::failed);
    const std::string running = job_with(1000, JobState::running);
    RetentionConfig config;
    config.keep_for = hours(24);
    tidy(config, hours(23));
    EXPECT_TRUE(has_frames(ended));
    tidy(config, hours(25));
    EXPECT_FALSE(has_frames(ended));
    EXPECT_FALSE(has_frames(failed));
    EXPECT_TRUE(has_frames(running));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "jobs" / ended));
    EXPECT_EQ(jobs_.find(ended)->state, JobState::succeeded);
    tidy(config, hours(50));
    EXPECT_EQ(jobs_.find(ended)->progress, 1);
}

TEST_F(RetentionTest, TheOldestGoFirstUntilTheRestFits) {
    std::vector<std::string> ids;
    for (int i = 0; i < 5; ++i) ids.push_back(job_with(1000));
    const std::string running = job_with(1000, JobState::running);
    RetentionConfig config;
    config.keep_at_most = 3500;
    tidy(config);
    for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(has_frames(ids[i]), i >= 3) << i;
    EXPECT_TRUE(has_frames(running));
    config.keep_at_most = 1;
    tidy(config);
    EXPECT_FALSE(has_frames(ids[4]));
    EXPECT_TRUE(has_frames(running)) << "whatever the limit";
}

TEST_F(RetentionTest, CachedRowsCountAndGoByAge) {
    const std::string id = job_with(1000);
    std::filesystem::create_directories(folder_.path() / "cache");
    write_file(folder_.path() / "cache" / "new", std::string(1000, 'c'));
    write_file(folder_.path() / "cache" / "old", std::string(1000, 'c'));
    std::filesystem::last_write_time(folder_.path() / "cache" / "old",
                                     std::filesystem::file_time_type::clock::now() - hours(5));
    RetentionConfig config;
    config.keep_at_most = 2500;
    tidy(config);
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "cache" / "old"));
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "cache" / "new"));
    EXPECT_TRUE(has_frames(id));
    config = {};
    config.keep_for = hours(24);
    tidy(config, hours(25));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "cache" / "new"));
}

TEST_F(RetentionTest, EventsGoButTheEnd) {
    const std::string id = job_with(1000);
    const auto log = jobs_.events(id);
    RetentionConfig config;
    config.keep_for = hours(1);
    tidy(config, hours(2));
    EXPECT_EQ(log->wait_after(0, std::chrono::milliseconds(0)).status, EventLog::Status::too_old);
    const auto left = log->wait_after(log->end()->id - 1, std::chrono::milliseconds(0));
    ASSERT_EQ(left.events.size(), 1U);
    EXPECT_EQ(left.events[0].kind, EventKind::end);
}

TEST_F(RetentionTest, WhatWasRemovedStaysSoAndIsComputedAgainWhenTriedAgain) {
    const std::string failed = job_with(1000, JobState::failed);
    const std::string ended = job_with(1000);
    RetentionConfig config;
    config.keep_for = hours(1);
    tidy(config, hours(2));
    JobStore later({}, &table_);
    EXPECT_TRUE(later.find(ended)->frames_removed);
    EXPECT_EQ(later.find(ended)->frames_done, 0);
    EXPECT_EQ(later.find(ended)->progress, 1);
    EXPECT_TRUE(later.requeue(failed));
    EXPECT_FALSE(later.find(failed)->frames_removed);
    EXPECT_EQ(later.first_unfinished(failed), 0);
}

TEST_F(RetentionTest, BlobsGoWithAgeAndSizeLikeTheRest) {
    const std::string one = sha256("one");
    const std::string other = sha256("other");
    blobs_.put(one, "one");
    blobs_.put(other, "other");
    RetentionConfig config;
    config.keep_for = hours(1);
    tidy(config);
    EXPECT_TRUE(blobs_.has(one));
    tidy(config, hours(2));
    EXPECT_FALSE(blobs_.has(one));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "blobs" / one));

    const std::string job = job_with(1000);
    blobs_.put(one, "one");
    blobs_.put(other, "other");
    EXPECT_TRUE(blobs_.has(one)) << "asked for again";
    config = {};
    config.keep_at_most = 3;
    tidy(config);
    EXPECT_FALSE(has_frames(job)) << "the oldest";
    EXPECT_FALSE(blobs_.has(other));
    EXPECT_TRUE(blobs_.has(one));
}

TEST_F(RetentionTest, UploadsThatNoJobHasGoWithAge) {
    const auto add_scene = [&](const std::string& bytes) { return scenes_.add(bytes, {}).scene.id; };
    Job draft;
    draft.scene = add_scene("used");
    draft.paths = scenes_.add_paths(R"({"used":1})");
    const std::string job = jobs_.add(draft).id;
    jobs_.start(job);
    jobs_.end(job, JobState::cancelled);
    const std::string scene = add_scene("unused"), paths = scenes_.add_paths(R"({"unused":1})");
    RetentionConfig config;
    config.keep_for = config.keep_uploads_for = hours(24);
    tidy(config, hours(23));
    EXPECT_TRUE(scenes_.find(scene));
    EXPECT_TRUE(scenes_.has_paths(paths));
    config.keep_uploads_for.reset();
    tidy(config, hours(25));
    EXPECT_TRUE(scenes_.find(scene)) << "only where it was asked for";
    config.keep_uploads_for = hours(24);
    tidy(config, hours(25));
    EXPECT_FALSE(scenes_.find(scene));
    EXPECT_FALSE(scenes_.has_paths(paths));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "uploads" / scene));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "uploads" / paths));
    EXPECT_TRUE(scenes_.find(draft.scene)) << "its job may be tried again";
    EXPECT_TRUE(scenes_.has_paths(draft.paths));
    const SceneStore later(folder_.path() / "uploads", surveys_here(fake_scene), &database_);
    EXPECT_FALSE(later.find(scene));
    EXPECT_TRUE(later.find(draft.scene));

    EXPECT_EQ(add_scene("unused"), scene) << "it can be uploaded again";
    EXPECT_TRUE(jobs_.remove(job));
    tidy(config, hours(25));
    EXPECT_FALSE(scenes_.find(draft.scene));
    EXPECT_FALSE(scenes_.has_paths(draft.paths));
}

TEST_F(RetentionTest, AnUploadThatIsAskedForIsYoungAgain) {
    const std::string scene = scenes_.add("bytes", {}).scene.id;
    const auto file = folder_.path() / "uploads" / scene;
    const auto make_old = [&] {
        std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now() - hours(5));
    };
    RetentionConfig config;
    config.keep_uploads_for = hours(1);
    make_old();
    EXPECT_TRUE(scenes_.ask_for(scene));
    tidy(config);
    EXPECT_TRUE(scenes_.find(scene)) << "a job is being submitted";
    make_old();
    scenes_.add("bytes", {});
    tidy(config);
    EXPECT_TRUE(scenes_.find(scene)) << "uploaded again";
    make_old();
    const SceneStore::Entry listed = scenes_.list().at(0);
    EXPECT_TRUE(scenes_.ask_for(scene));
    scenes_.remove(listed);
    EXPECT_TRUE(scenes_.find(scene)) << "asked for since it was listed";
    make_old();
    tidy(config);
    EXPECT_FALSE(scenes_.find(scene));
    EXPECT_FALSE(scenes_.ask_for(scene));
}

TEST_F(RetentionTest, LooksByItself) {
    const std::string id = job_with(1000);
    RetentionConfig config;
    config.keep_for = hours(1);
    config.interval = std::chrono::milliseconds(1);
    const Retention retention(jobs_, frames_, scenes_, blobs_, folder_.path() / "cache", config,
                              [] { return std::chrono::system_clock::now() + hours(2); });
    while (!jobs_.find(id)->frames_removed) std::this_thread::yield();
    while (frames_.bytes_of(id) > 0) std::this_thread::yield();
    EXPECT_FALSE(has_frames(id));
}

}  // namespace
}  // namespace afterglow
