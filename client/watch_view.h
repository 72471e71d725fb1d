#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "client/event_stream.h"
#include "client/job.h"

namespace afterglow::client {

/// What a watcher knows of a job so far, put together from its events.
struct WatchView {
    std::optional<Job> job;            ///< the last whole job seen, if any
    JobState state = JobState::other;  ///< newest
    std::string state_name;            ///< newest; "" before anything is known
    std::set<int> finished;            ///< frames whose final picture exists
    std::optional<FrameImage> image;   ///< the newest picture
    int current_frame = -1;            ///< the frame being worked on; −1 before any
    double progress = 0;               ///< of the whole job, 0 to 1
    std::string doing;
    std::optional<double> remaining_s;
    std::set<std::string> warned;  ///< warnings already told
    std::string error;             ///< why the job failed, one line; empty unless known

    /// Frames asked for; 0 while unknown.
    [[nodiscard]] int frame_count() const { return job ? job->frame_count() : 0; }
};

/// What an event brought that is worth telling.
struct WatchNews {
    enum class Kind { nothing, state, progress, image, final_image, edit };
    Kind kind = Kind::nothing;
    std::optional<FrameImage> image;    ///< of an image
    std::vector<std::string> warnings;  ///< one line each; only those not told before
    std::string told = {};              ///< of an edit, one line
};

/// Brings the view up to date. A repeated event (after a replay) is no news. Errors: no_server naming `place`
/// where an event's data is no JSON or lacks what it must have.
WatchNews apply_event(WatchView& view, const ServerEvent& event, const std::string& place);

}  // namespace afterglow::client
