#include "client/job.h"

#include <gtest/gtest.h>

#include "client/fetch.h"

namespace afterglow::client {
namespace {

TEST(Job, ReadsWhatPeopleAreShown) {
    const Job job =
        read_job(Json::parse(R"({"id":"j1","state":"failed","scene":"s1","first_frame":3,"last_frame":9,
        "frames_done":2,"progress":0.25,"doing":"shooting","remaining_s":12.5,"created":"2024-01-01T00:00:00.000Z",
        "error":{"detail":"is dark","place":"lamp"},"warnings":[{"place":"a","message":"b"},{"message":"c"}]})"),
                 "s");
    EXPECT_EQ(job.id, "j1");
    EXPECT_EQ(job.state, JobState::failed);
    EXPECT_EQ(job.frame_count(), 7);
    EXPECT_EQ(job.frames_done, 2);
    EXPECT_EQ(job.progress, 0.25);
    EXPECT_EQ(job.doing, "shooting");
    EXPECT_EQ(job.remaining_s, 12.5);
    EXPECT_EQ(job.error, "lamp: is dark");
    ASSERT_EQ(job.warnings.size(), 2U);
    EXPECT_EQ(warning_line(job.warnings[0]), "a: b");
    EXPECT_EQ(warning_line(job.warnings[1]), "c");
}

TEST(Job, NeedsOnlyAnIdAndAState) {
    const Job job =
        read_job(Json::parse(R"({"id":"j","state":"dreaming","remaining_s":null,"error":null})"), "s");
    EXPECT_EQ(job.state, JobState::other);
    EXPECT_EQ(job.state_name, "dreaming");
    EXPECT_FALSE(has_ended(job.state)) << "a state of a newer server is no end";
    EXPECT_EQ(job.frame_count(), 0);
    EXPECT_THROW(read_job(Json::parse(R"({"id":"j"})"), "s"), ClientError);
    EXPECT_THROW(read_job(Json::parse(R"({"id":1,"state":"queued"})"), "s"), ClientError);
    EXPECT_THROW(read_job(Json::parse("[]"), "s"), ClientError);
}

TEST(Job, EachEndHasItsExitCode) {
    EXPECT_EQ(exit_code_of(job_state_of("succeeded")), ExitCode::ok);
    EXPECT_EQ(exit_code_of(job_state_of("failed")), ExitCode::job_failed);
    EXPECT_EQ(exit_code_of(job_state_of("cancelled")), ExitCode::job_cancelled);
}

TEST(FrameImage, ReadsListEntriesAndEvents) {
    const auto entry = read_frame_image(
        Json::parse(R"({"frame":4,"revision":3,"final":true,"residual":0.5,"png":"/p","exr":"/e"})"), "s");
    EXPECT_EQ(entry.frame, 4);
    EXPECT_EQ(entry.revision, 3);
    EXPECT_EQ(entry.stage, FrameImage::Stage::final);
    EXPECT_EQ(entry.residual, 0.5);
    EXPECT_EQ(entry.png, "/p");
    EXPECT_EQ(entry.exr, "/e");
    const auto event = read_frame_image(Json::parse(R"({"frame":0,"url":"/u","final":false})"), "s");
    EXPECT_EQ(event.png, "/u");
    EXPECT_EQ(event.stage, FrameImage::Stage::preliminary);
    EXPECT_THROW(read_frame_image(Json::parse(R"({"url":"/u"})"), "s"), ClientError);
    EXPECT_THROW(read_frame_image(Json::parse(R"({"frame":-1})"), "s"), ClientError);
}

TEST(FrameFileName, HasFourDigitsOrMore) {
    EXPECT_EQ(frame_file_name(0, "png"), "frame_0000.png");
    EXPECT_EQ(frame_file_name(123, "exr"), "frame_0123.exr");
    EXPECT_EQ(frame_file_name(123456, "exr"), "frame_123456.exr");
}

}  // namespace
}  // namespace afterglow::client
