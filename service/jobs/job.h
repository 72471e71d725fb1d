#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/base/frame_range.h"
#include "service/base/problem.h"
#include "service/base/timestamp.h"
#include "service/jobs/edit.h"
#include "service/jobs/frame_info.h"
#include "solver/base/error.h"
#include "solver/base/math.h"
#include "solver/sequence/sequence.h"

namespace afterglow {

/// Where a job stands.
enum class JobState { queued, running, paused, succeeded, failed, cancelled };
inline constexpr std::array all_job_states = {JobState::queued,    JobState::running, JobState::paused,
                                              JobState::succeeded, JobState::failed,  JobState::cancelled};

std::string_view name_of(JobState state);
/// True for the last three states.
bool has_ended(JobState state);
/// The legal transitions: queued → running, paused, failed, cancelled; running → paused, succeeded, failed,
/// cancelled; paused → queued, failed, cancelled; failed, cancelled → queued (tried again). An edit also
/// brings succeeded → queued: see may_be_edited.
bool may_follow(JobState from, JobState to);
/// True but for cancelled jobs.
bool may_be_edited(JobState state);

/// What a client asks for.
struct JobSettings {
    std::optional<FrameRange> frames;  ///< the whole animation where not given
    SequenceConfig sequence;           ///< handed to the solver as it is
    std::optional<Rgb> background;     ///< replaces the scene's own background radiance, W/m²/sr, ≥ 0
};

/// A job as clients see it. A value; the service's own copy lives in JobStore.
struct Job {
    std::string id;
    JobState state = JobState::queued;
    std::string scene;  ///< id of the upload
    std::string paths;  ///< id of the upload; empty: none
    JobSettings settings;
    int priority = 0;               ///< −10 to 10; higher goes first
    FrameRange frames;              ///< what will be computed
    double frames_per_second = 24;  ///< at which they are to be shown
    std::vector<JobEdit> edits;     ///< in the order they were accepted
    int frames_done = 0;            ///< frames with a final picture that still holds
    int stale_frames = 0;           ///< with a final picture from before an edit
    double progress = 0;            ///< of the whole job, in [0, 1]; only edits lower it
    std::string doing;              ///< what is being done, for people
    std::optional<std::chrono::duration<double>> remaining;  ///< estimated; empty while unknown
    Timestamp created{};
    std::optional<Timestamp> started;
    std::optional<Timestamp> ended;
    std::optional<Timestamp> frames_removed;  ///< when its pictures were, to make room
    std::optional<Problem> error;             ///< why it failed
    Warnings warnings;
    SequenceStatistics statistics;
    int strikes = 0;               ///< times that a process ended while it computed `strike_frame`
    int strike_frame = 0;          ///< the last frame with which that happened
    std::string owner;             ///< name of the client that submitted it
    std::string idempotency_key;   ///< as the client gave it; empty: none
    std::string idempotency_hash;  ///< of the request that came with it

    [[nodiscard]] int frame_count() const { return frames.last - frames.first + 1; }
    /// How often it has been edited.
    [[nodiscard]] int revision() const { return static_cast<int>(edits.size()); }
    /// Whether a picture shows a job that has been edited since, where that changes its frame.
    [[nodiscard]] bool is_stale(const FrameInfo& info) const;
};

}  // namespace afterglow
