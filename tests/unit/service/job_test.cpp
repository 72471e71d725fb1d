#include "service/jobs/job.h"

#include <array>

#include <gtest/gtest.h>

namespace afterglow {
namespace {

constexpr std::array all_states = {JobState::queued, JobState::running, JobState::succeeded, JobState::failed,
                                   JobState::cancelled};

TEST(Job, NothingFollowsAnEndAndNothingGoesBack) {
    for (const JobState from : all_states)
        for (const JobState to : all_states) {
            if (has_ended(from)) {
                EXPECT_FALSE(may_follow(from, to));
            }
            if (to == from || to == JobState::queued) {
                EXPECT_FALSE(may_follow(from, to));
            }
        }
}

TEST(Job, OnlyARunningJobSucceedsAndAnyActiveOneMayBeStopped) {
    EXPECT_FALSE(may_follow(JobState::queued, JobState::succeeded));
    EXPECT_TRUE(may_follow(JobState::queued, JobState::running));
    EXPECT_TRUE(may_follow(JobState::running, JobState::succeeded));
    for (const JobState from : {JobState::queued, JobState::running}) {
        EXPECT_TRUE(may_follow(from, JobState::failed));
        EXPECT_TRUE(may_follow(from, JobState::cancelled));
    }
}

}  // namespace
}  // namespace afterglow
