#include "client/progress_line.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "client/text.h"

namespace afterglow::client {

namespace {

std::string bar(double share, int cells) {
    const double safe = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0;
    const auto full = static_cast<std::size_t>(std::floor(safe * cells));
    return "[" + std::string(full, '#') + std::string(static_cast<std::size_t>(cells) - full, '.') + "]";
}

std::string frame_part(const WatchView& view) {
    const int count = view.frame_count();
    if (count == 0 || view.current_frame < 0) return {};
    const int position = view.current_frame - view.job->first_frame + 1;
    return "  frame " + std::to_string(position) + " of " + std::to_string(count);
}

std::string image_part(const WatchView& view) {
    if (!view.image || view.image->frame != view.current_frame) return {};
    std::string part = "  revision " + std::to_string(view.image->revision);
    if (view.image->residual) part += "  residual " + percent(*view.image->residual);
    return part;
}

/// Cuts to that many bytes without leaving half a UTF-8 character; columns are never more than bytes.
std::string cut(std::string text, int columns) {
    std::size_t size = std::min(text.size(), static_cast<std::size_t>(std::max(columns, 0)));
    while (size > 0 && size < text.size() && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U)
        --size;
    text.resize(size);
    return text;
}

}  // namespace

std::string progress_line(const WatchView& view, int columns) {
    const int cells = std::clamp(columns / 4, 4, 30);
    std::string line = bar(view.progress, cells) + " " + percent(std::floor(view.progress * 100) / 100);
    if (has_ended(view.state) || view.state == JobState::queued) line += "  " + view.state_name;
    line += frame_part(view) + image_part(view);
    if (view.remaining_s && !has_ended(view.state))
        line += "  " + spoken(std::chrono::duration<double>(*view.remaining_s)) + " left";
    // What it is at comes last: the first to go on a narrow terminal.
    if (!view.doing.empty() && !has_ended(view.state)) line += "  " + view.doing;
    return cut(std::move(line), columns);
}

std::string finished_line(const WatchView& view, const FrameImage& image) {
    std::string line = "frame " + std::to_string(image.frame) + " done";
    if (view.frame_count() > 0)
        line +=
            " (" + std::to_string(view.finished.size()) + " of " + std::to_string(view.frame_count()) + ")";
    line += ": revision " + std::to_string(image.revision);
    if (image.residual) line += ", residual " + percent(*image.residual);
    return line;
}

std::string state_line(const WatchView& view) {
    std::string line = view.state_name;
    if (!has_ended(view.state) && view.frame_count() > 0) {
        line += ", " + std::to_string(view.frame_count()) + (view.frame_count() == 1 ? " frame" : " frames");
        if (!view.finished.empty()) line += ", " + std::to_string(view.finished.size()) + " done";
    }
    return line;
}

}  // namespace afterglow::client
