#include "service/commands/report.h"

#include <sys/resource.h>
#include <system_error>

#include "solver/base/error.h"
#include "solver/base/file.h"

namespace afterglow {

namespace {

Json or_null(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json frame_json(const FrameStatistics& frame) {
    return {{"frame", frame.frame},
            {"ms",
             {{"visibility", frame.visibility.count()},
              {"solve", frame.solve.count()},
              {"image", frame.image.count()},
              {"total", frame.total.count()}}},
            {"rays_traced", frame.rays_traced},
            {"visibility_changes", frame.visibility_changes},
            {"shots", frame.shots},
            {"active_patches", frame.active_patches},
            {"residual", frame.residual},
            {"error_bound", frame.error_bound},
            {"picture_error", or_null(frame.picture_error)},
            {"picture_error_spread", or_null(frame.picture_error_spread)},
            {"line_noise", or_null(frame.line_noise)}};
}

}  // namespace

double peak_memory_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;  // the kernel counts in KiB
}

Json to_json(const Report& report, double peak_rss_mb) {
    Json frames = Json::array();
    for (const FrameStatistics& frame : report.frames) frames.push_back(frame_json(frame));
    Json ahead = Json::array();
    for (const WorkAhead& work : report.sequence.work_ahead)
        ahead.push_back({{"first_frame", work.frames.first},
                         {"last_frame", work.frames.last},
                         {"ms", work.time.count()}});
    return {{"scene", report.scene},
            {"method", report.sequence.method},
            {"patches", report.sequence.patches},
            {"actor_patches", report.sequence.actor_patches},
            {"sight_lines", report.sequence.sight_lines},
            {"rays_per_patch", report.sequence.rays_per_patch},
            {"load_ms", report.load.count()},
            {"static_ms", report.static_pass.count()},
            {"precompute", std::move(ahead)},
            {"peak_rss_mb", peak_rss_mb},
            {"frames", std::move(frames)},
            {"made_for_error", or_null(report.sequence.made_for_error)},
            {"method_reason", report.sequence.method_reason}};
}

void require_writable_file(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    // A device or a folder must not be replaced by a file of its name.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw Error(ErrorKind::invalid_input, path.string(), "is not a regular file");
    std::filesystem::path probe = path;
    probe += ".probe";
    try {
        write_file(probe, "");
    } catch (const Error& e) {
        throw Error(ErrorKind::invalid_input, path.string(), e.message());
    }
    std::filesystem::remove(probe, error);
}

}  // namespace afterglow
