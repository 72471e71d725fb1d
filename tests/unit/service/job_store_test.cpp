#include "service/store/job_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/json.h"

namespace afterglow {
namespace {

Job draft(int frames = 4) {
    Job job;
    job.scene = "scene";
    job.frames = {0, frames - 1};
    return job;
}

std::vector<Event> events_of(const JobStore& jobs, const std::string& id) {
    return jobs.events(id)->wait_after(0, std::chrono::milliseconds(0)).events;
}

std::vector<std::string> names_of(const std::vector<Event>& events) {
    std::vector<std::string> names;
    for (const Event& event : events) names.emplace_back(name_of(event.kind));
    return names;
}

TEST(JobStore, TellsALifeInOrder) {
    JobStore jobs;
    const std::string id = jobs.add(draft(1)).id;
    EXPECT_TRUE(jobs.start(id));
    jobs.note_picture(id, {0, 1, false, 0.5, {}});
    jobs.note_picture(id, {0, 2, true, 0.1, 0.2, 0.03});
    EXPECT_TRUE(jobs.end(id, JobState::succeeded));
    const auto events = events_of(jobs, id);
    EXPECT_THAT(names_of(events), testing::ElementsAre("job", "job", "image", "image", "job", "end"));
    const Json image = parse_json(events[3].data, "event");
    EXPECT_EQ(image.at("final"), true);
    EXPECT_EQ(image.at("error_bound"), 0.2);
    EXPECT_EQ(image.at("picture_error"), 0.03);
    EXPECT_EQ(parse_json(events[2].data, "event").at("error_bound"), nullptr);
    EXPECT_EQ(parse_json(events[2].data, "event").at("picture_error"), nullptr);
    const Json job = parse_json(events[4].data, "event");
    EXPECT_EQ(job.at("state"), "succeeded");
    EXPECT_EQ(job.at("frames_done"), 1);
    EXPECT_EQ(job.at("progress"), 1);
    EXPECT_EQ(events[5].data, R"({"state":"succeeded"})");
}

TEST(JobStore, GoesOnAtTheFirstFrameThatIsMissing) {
    JobStore jobs;
    const std::string id = jobs.add(draft(5)).id;
    EXPECT_TRUE(jobs.start(id));
    EXPECT_EQ(jobs.first_unfinished(id), 0);
    for (const int frame : {0, 1, 3}) jobs.note_picture(id, {frame, 1, true, 0, {}});
    EXPECT_EQ(jobs.first_unfinished(id), 2);
    // A full disk, say, did not take one that was told of.
    jobs.forget_picture(id, 1);
    EXPECT_EQ(jobs.first_unfinished(id), 1);
    EXPECT_EQ(jobs.find(id)->frames_done, 2);
}

TEST(JobStore, AfterAnotherTryTheOldEndIsNotTold) {
    JobStore jobs;
    const std::string id = jobs.add(draft()).id;
    EXPECT_TRUE(jobs.end(id, JobState::cancelled));
    EXPECT_TRUE(jobs.requeue(id));
    EXPECT_THAT(names_of(events_of(jobs, id)), testing::ElementsAre("job", "job", "job"));
}

TEST(JobStore, AnEndedJobNeverChanges) {
    JobStore jobs;
    const std::string id = jobs.add(draft()).id;
    EXPECT_TRUE(jobs.end(id, JobState::cancelled));
    const auto before = events_of(jobs, id).size();
    EXPECT_FALSE(jobs.start(id));
    EXPECT_FALSE(jobs.end(id, JobState::failed, Problem{}));
    jobs.note_progress(id, 0, 0, {0.5, "late", {}});
    jobs.note_picture(id, {0, 1, true, 0, {}});
    jobs.note_warnings(id, {{"late", "late"}});
    EXPECT_EQ(events_of(jobs, id).size(), before);
    EXPECT_EQ(jobs.find(id)->state, JobState::cancelled);
    EXPECT_EQ(jobs.find(id)->progress, 0);
}

TEST(JobStore, OnlyARunningJobSucceeds) {
    JobStore jobs;
    const std::string id = jobs.add(draft()).id;
    EXPECT_FALSE(jobs.end(id, JobState::succeeded));
    EXPECT_FALSE(jobs.end(id, JobState::running));
    EXPECT_EQ(jobs.find(id)->state, JobState::queued);
}

TEST(JobStore, TheEndStopsTheWork) {
    JobStore jobs;
    const std::string id = jobs.add(draft()).id;
    const std::stop_token stop = jobs.stop_token(id);
    EXPECT_FALSE(stop.stop_requested());
    jobs.end(id, JobState::cancelled);
    EXPECT_TRUE(stop.stop_requested());
}

TEST(JobStore, ProgressIsOfTheWholeJobAndNeverDecreases) {
    JobStore jobs({.events = {}, .progress_interval = std::chrono::milliseconds(0)});
    const std::string id = jobs.add(draft(4)).id;
    jobs.start(id);
    jobs.note_progress(id, 2, 2, {0.5, "solving", {}});
    EXPECT_DOUBLE_EQ(jobs.find(id)->progress, 0.625);
    jobs.note_progress(id, 1, 1, {0.5, "again", {}});
    EXPECT_DOUBLE_EQ(jobs.find(id)->progress, 0.625);
    EXPECT_EQ(jobs.find(id)->doing, "again");
    EXPECT_TRUE(jobs.find(id)->remaining.has_value());
    jobs.note_progress(id, 3, 3, {7.0, "too much", {}});
    EXPECT_EQ(jobs.find(id)->progress, 1);
}

TEST(JobStore, ProgressEventsAreRare) {
    JobStore jobs({.events = {}, .progress_interval = std::chrono::hours(1)});
    const std::string id = jobs.add(draft()).id;
    jobs.start(id);
    for (int i = 0; i < 100; ++i) jobs.note_progress(id, 0, 0, {i / 100.0, "solving", {}});
    EXPECT_EQ(jobs.events(id)->last_id(), 3U);  // two of the job, one of progress
    EXPECT_NEAR(jobs.find(id)->progress, 0.99 / 4, 1e-12);
}

TEST(JobStore, AWarningIsToldOnce) {
    JobStore jobs;
    Job job = draft();
    job.warnings = {{"scene", "first"}};
    const std::string id = jobs.add(job).id;
    for (int i = 0; i < 3; ++i) jobs.note_warnings(id, {{"scene", "first"}, {"run", "second"}});
    EXPECT_THAT(names_of(events_of(jobs, id)), testing::ElementsAre("job", "warning", "warning"));
    EXPECT_EQ(jobs.find(id)->warnings.size(), 2U);
}

TEST(JobStore, AFailureTellsItsProblem) {
    JobStore jobs;
    const std::string id = jobs.add(draft()).id;
    jobs.start(id);
    jobs.end(id, JobState::failed, Problem{422, "cannot_converge", "grows", "wall"});
    EXPECT_THAT(names_of(events_of(jobs, id)), testing::ElementsAre("job", "job", "error", "job", "end"));
    EXPECT_EQ(jobs.find(id)->error->place, "wall");
}

TEST(JobStore, ListsTheNewestFirst) {
    JobStore jobs;
    const std::string first = jobs.add(draft()).id;
    const std::string second = jobs.add(draft()).id;
    ASSERT_EQ(jobs.list()->size(), 2U);
    EXPECT_EQ((*jobs.list())[0].id, second);
    EXPECT_EQ((*jobs.list())[1].id, first);
}

TEST(JobStore, UnknownJobsAreNoError) {
    JobStore jobs;
    EXPECT_FALSE(jobs.find("x").has_value());
    EXPECT_EQ(jobs.events("x"), nullptr);
    EXPECT_FALSE(jobs.end("x", JobState::cancelled));
    EXPECT_FALSE(jobs.start("x"));
}

}  // namespace
}  // namespace afterglow
