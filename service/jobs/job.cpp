#include "service/jobs/job.h"

namespace afterglow {

std::string_view name_of(JobState state) {
    switch (state) {
        case JobState::queued:
            return "queued";
        case JobState::running:
            return "running";
        case JobState::succeeded:
            return "succeeded";
        case JobState::failed:
            return "failed";
        case JobState::cancelled:
            return "cancelled";
    }
    return "";
}

bool has_ended(JobState state) {
    return state != JobState::queued && state != JobState::running;
}

bool may_follow(JobState from, JobState to) {
    if (has_ended(from) || to == JobState::queued || from == to) return false;
    // Nothing succeeds that never ran.
    return from == JobState::running || to != JobState::succeeded;
}

}  // namespace afterglow
