#include "client/job.h"

#include <array>
#include <utility>

#include "client/problem.h"
#include "client/text.h"

namespace afterglow::client {

JobState job_state_of(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, JobState>, 5> states{{
        {"queued", JobState::queued},
        {"running", JobState::running},
        {"succeeded", JobState::succeeded},
        {"failed", JobState::failed},
        {"cancelled", JobState::cancelled},
    }};
    for (const auto& [known, state] : states)
        if (name == known) return state;
    return JobState::other;
}

bool has_ended(JobState state) {
    return state == JobState::succeeded || state == JobState::failed || state == JobState::cancelled;
}

ExitCode exit_code_of(JobState state) {
    if (state == JobState::succeeded) return ExitCode::ok;
    return state == JobState::cancelled ? ExitCode::job_cancelled : ExitCode::job_failed;
}

JobWarning read_warning(const Json& warning) {
    return {find_string(warning, "place").value_or(""), find_string(warning, "message").value_or("")};
}

std::vector<JobWarning> read_warnings(const Json& warnings) {
    std::vector<JobWarning> out;
    if (warnings.is_array())
        for (const Json& warning : warnings) out.push_back(read_warning(warning));
    return out;
}

std::string warning_line(const JobWarning& warning) {
    return one_line(warning.place.empty() ? warning.message : warning.place + ": " + warning.message);
}

int Job::frame_count() const {
    return last_frame < first_frame ? 0 : last_frame - first_frame + 1;
}

Job read_job(const Json& json, const std::string& place) {
    Job job;
    job.id = need_string(json, "id", place);
    job.state_name = one_line(need_string(json, "state", place));
    job.state = job_state_of(job.state_name);
    job.first_frame = find_int(json, "first_frame").value_or(0);
    job.last_frame = find_int(json, "last_frame").value_or(-1);
    job.frames_done = find_int(json, "frames_done").value_or(0);
    job.progress = find_number(json, "progress").value_or(0);
    job.doing = one_line(find_string(json, "doing").value_or(""));
    job.remaining_s = find_number(json, "remaining_s");
    job.created = one_line(find_string(json, "created").value_or(""));
    job.scene = one_line(find_string(json, "scene").value_or(""));
    const Json& error = find_member(json, "error");
    if (error.is_object()) job.error = problem_line(error);
    job.warnings = read_warnings(find_member(json, "warnings"));
    return job;
}

FrameImage read_frame_image(const Json& json, const std::string& place) {
    const auto frame = find_int(json, "frame");
    if (!frame || *frame < 0)
        throw ClientError(ExitCode::no_server, place, "sent a picture without a frame number");
    FrameImage image;
    image.frame = *frame;
    image.revision = find_int(json, "revision").value_or(0);
    image.job_revision = find_int(json, "job_revision").value_or(0);
    if (is_true(json, "final"))
        image.stage = is_true(json, "stale") ? FrameImage::Stage::stale : FrameImage::Stage::final;
    image.residual = find_number(json, "residual");
    image.png = find_string(json, "png").value_or(find_string(json, "url").value_or(""));
    image.exr = find_string(json, "exr").value_or("");
    return image;
}

}  // namespace afterglow::client
