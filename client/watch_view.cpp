#include "client/watch_view.h"

#include "client/problem.h"
#include "client/text.h"

namespace afterglow::client {

namespace {

using Kind = WatchNews::Kind;

WatchNews take_state(WatchView& view, std::string_view name) {
    const std::string shown = one_line(name);
    if (shown == view.state_name) return {};
    view.state_name = shown;
    view.state = job_state_of(shown);
    return {Kind::state, {}, {}};
}

std::vector<std::string> new_warnings(WatchView& view, const std::vector<JobWarning>& warnings) {
    std::vector<std::string> lines;
    for (const JobWarning& warning : warnings)
        if (std::string line = warning_line(warning); view.warned.insert(line).second) lines.push_back(line);
    return lines;
}

WatchNews take_image(WatchView& view, const FrameImage& image) {
    // A replay repeats pictures; one that is older than what is shown is no news.
    if (image.stage == FrameImage::Stage::stale) return {};
    const bool known_final = view.finished.contains(image.frame);
    const bool superseded =
        view.image && view.image->frame == image.frame && view.image->revision >= image.revision;
    if (known_final || superseded) return {};
    view.image = image;
    view.current_frame = image.frame;
    if (image.stage == FrameImage::Stage::preliminary) return {Kind::image, image, {}};
    view.finished.insert(image.frame);
    return {Kind::final_image, image, {}};
}

WatchNews take_job(WatchView& view, const Json& data, const std::string& place) {
    view.job = read_job(data, place);
    view.progress = view.job->progress;
    view.doing = view.job->doing;
    view.remaining_s = view.job->remaining_s;
    if (!view.job->error.empty()) view.error = view.job->error;
    WatchNews news = take_state(view, view.job->state_name);
    news.warnings = new_warnings(view, view.job->warnings);
    return news;
}

WatchNews take_snapshot(WatchView& view, const Json& data, const std::string& place) {
    WatchNews news = take_job(view, data, place);
    const Json& frames = find_member(data, "frames");
    if (frames.is_array())
        for (const Json& frame : frames) take_image(view, read_frame_image(frame, place));
    return news;
}

WatchNews take_progress(WatchView& view, const Json& data) {
    view.current_frame = find_int(data, "frame").value_or(view.current_frame);
    view.progress = find_number(data, "progress").value_or(view.progress);
    view.doing = one_line(find_string(data, "doing").value_or(view.doing));
    view.remaining_s = find_number(data, "remaining_s");
    return {Kind::progress, {}, {}};
}

/// Frames from the first one that an edit changes are to be finished again.
WatchNews take_edit(WatchView& view, const Json& data) {
    const int first = find_int(data, "first_frame").value_or(0);
    view.finished.erase(view.finished.lower_bound(first), view.finished.end());
    return {Kind::edit, {}, {}, "edited: frames from " + std::to_string(first) + " on are computed again"};
}

WatchNews take_reused(const Json& data) {
    return {Kind::edit,
            {},
            {},
            "the edit kept " + percent(find_number(data, "reused").value_or(0)) + " of all lines"};
}

}  // namespace

WatchNews apply_event(WatchView& view, const ServerEvent& event, const std::string& place) {
    const Json data = parse_json(event.data, place);
    if (event.name == "snapshot") return take_snapshot(view, data, place);
    if (event.name == "job") return take_job(view, data, place);
    if (event.name == "progress") return take_progress(view, data);
    if (event.name == "image") return take_image(view, read_frame_image(data, place));
    if (event.name == "edit") return take_edit(view, data);
    if (event.name == "reused") return take_reused(data);
    if (event.name == "warning") return {Kind::nothing, {}, new_warnings(view, {read_warning(data)})};
    if (event.name == "error") view.error = problem_line(data);
    if (event.name == "end") return take_state(view, need_string(data, "state", place));
    return {};  // an event of a newer server
}

}  // namespace afterglow::client
