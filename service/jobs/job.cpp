#include "service/jobs/job.h"

namespace afterglow {

std::string_view name_of(JobState state) {
    switch (state) {
        case JobState::queued:
            return "queued";
        case JobState::running:
            return "running";
        case JobState::paused:
            return "paused";
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
    return state == JobState::succeeded || state == JobState::failed || state == JobState::cancelled;
}

bool may_be_edited(JobState state) {
    return state != JobState::cancelled;
}

bool Job::is_stale(const FrameInfo& info) const {
    for (std::size_t later = static_cast<std::size_t>(info.job_revision); later < edits.size(); ++later)
        if (info.frame >= edits[later].first_frame) return true;
    return false;
}

bool may_follow(JobState from, JobState to) {
    if (from == to || from == JobState::succeeded) return false;
    if (has_ended(from)) return to == JobState::queued;
    if (to == JobState::queued) return from == JobState::paused;
    if (to == JobState::running) return from == JobState::queued;
    // Nothing succeeds that is not running.
    return from == JobState::running || to != JobState::succeeded;
}

}  // namespace afterglow
