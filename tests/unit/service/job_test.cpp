#include "service/jobs/job.h"

#include <map>
#include <set>
#include <string_view>

#include <gtest/gtest.h>

namespace afterglow {
namespace {

TEST(Job, TheLegalTransitionsAreTheseAndNoOthers) {
    using enum JobState;
    const std::map<JobState, std::set<JobState>> legal = {{queued, {running, paused, failed, cancelled}},
                                                          {running, {paused, succeeded, failed, cancelled}},
                                                          {paused, {queued, failed, cancelled}},
                                                          {succeeded, {}},
                                                          {failed, {queued}},
                                                          {cancelled, {queued}}};
    for (const JobState from : all_job_states)
        for (const JobState to : all_job_states)
            EXPECT_EQ(may_follow(from, to), legal.at(from).contains(to)) << name_of(from) << name_of(to);
}

TEST(Job, NamesAreApart) {
    std::set<std::string_view> names;
    for (const JobState state : all_job_states) names.insert(name_of(state));
    EXPECT_EQ(names.size(), all_job_states.size());
}

}  // namespace
}  // namespace afterglow
