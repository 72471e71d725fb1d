#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/exit_code.h"
#include "client/json.h"

namespace afterglow::client {

enum class JobState { queued, running, succeeded, failed, cancelled, other };

/// `other` for a state this client does not know; a job in it has not ended.
JobState job_state_of(std::string_view name);
bool has_ended(JobState state);
/// How `watch` exits after a job that ended so.
ExitCode exit_code_of(JobState state);

/// A warning of the server about a scene or a job.
struct JobWarning {
    std::string place;
    std::string message;
    bool operator==(const JobWarning&) const = default;
};
JobWarning read_warning(const Json& warning);
std::vector<JobWarning> read_warnings(const Json& warnings);
/// "place: message", or the message alone; one line.
std::string warning_line(const JobWarning& warning);

/// A job as the server shows it: what people are shown of it.
struct Job {
    std::string id;
    std::string state_name;
    JobState state = JobState::other;
    int first_frame = 0;
    int last_frame = 0;
    int frames_done = 0;
    double progress = 0;                ///< of the whole job, 0 to 1
    std::string doing;                  ///< what it is at, may be empty
    std::optional<double> remaining_s;  ///< estimated
    std::string created;                ///< RFC 3339
    std::string scene;                  ///< its id
    std::string error;                  ///< one line; empty unless it failed
    std::vector<JobWarning> warnings;

    /// Frames asked for; 0 where the server did not say.
    [[nodiscard]] int frame_count() const;
};

/// Reads a job object. Errors: no_server naming `place` where there is no id or state.
Job read_job(const Json& json, const std::string& place);

/// The newest picture of a frame, from the list of frames or from an image event.
struct FrameImage {
    int frame = 0;
    int revision = 0;
    /// Stale: a final one from before an edit that changed its frame.
    enum class Stage { preliminary, final, stale } stage = Stage::preliminary;
    std::optional<double> residual;
    std::string png;  ///< path on the server; empty where there is none
    std::string exr;
    int job_revision = 0;  ///< how often the job had been edited that it shows
};
/// Reads an entry of `/frames` or an `image` event. Errors: no_server where the frame is missing or negative.
FrameImage read_frame_image(const Json& json, const std::string& place);

}  // namespace afterglow::client
