#include "service/jobs/job_json.h"

#include <optional>

namespace afterglow {

namespace {

std::string_view name_of_quality(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return "draft";
        case Quality::preview:
            return "preview";
        case Quality::final:
            return "final";
    }
    return "";
}

/// The named method of a pair of axes, or null.
Json method_json(const SequenceConfig& config) {
    for (const Method& method : methods())
        if (method.visibility == config.visibility && method.solution == config.solution) return method.name;
    return nullptr;
}

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json time_or_null(const std::optional<Timestamp>& time) {
    return time ? Json(to_rfc3339(*time)) : Json(nullptr);
}

}  // namespace

Json to_json(const SequenceStatistics& statistics) {
    return {{"method", statistics.method},
            {"method_reason", statistics.method_reason},
            {"patches", statistics.patches},
            {"actor_patches", statistics.actor_patches},
            {"sight_lines", statistics.sight_lines},
            {"rays_per_patch", statistics.rays_per_patch},
            {"setup_ms", statistics.setup.count()},
            {"static_ms", statistics.static_pass.count()},
            {"static_from_cache", statistics.static_from_cache},
            {"exposure_ev", or_null(statistics.exposure_ev)},
            {"made_for_error", or_null(statistics.made_for_error)}};
}

Json to_json(const Warning& warning) {
    return {{"place", warning.place}, {"message", warning.message}};
}

Json to_json(const Warnings& warnings) {
    Json json = Json::array();
    for (const Warning& warning : warnings) json.push_back(to_json(warning));
    return json;
}

Json to_json(const JobSettings& settings) {
    const SequenceConfig& config = settings.sequence;
    Json json;
    json["frames"] =
        settings.frames
            ? Json(std::to_string(settings.frames->first) + "-" + std::to_string(settings.frames->last))
            : Json(nullptr);
    json["fps"] = config.frames_per_second > 0 ? Json(config.frames_per_second) : Json(nullptr);
    json["width"] = config.width;
    json["height"] = config.height;
    json["quality"] = name_of_quality(config.quality);
    json["method"] = method_json(config);
    json["visibility"] = name_of(config.visibility);
    json["solution"] = name_of(config.solution);
    json["rays"] = or_null(config.rays_per_patch);
    json["patch_size_m"] = or_null(config.patch_size_m);
    json["error"] = or_null(config.asked_error);
    json["estimate"] = name_of(config.estimate);
    json["camera"] = config.camera.empty() ? Json(nullptr) : Json(config.camera);
    json["seed"] = config.seed;
    json["exposure_ev"] = or_null(config.exposure_ev);
    json["background"] = nullptr;
    if (const auto& b = settings.background) json["background"] = Json::array({b->r, b->g, b->b});
    return json;
}

Json to_json(const Job& job) {
    return {{"id", job.id},
            {"state", name_of(job.state)},
            {"scene", job.scene},
            {"paths", job.paths.empty() ? Json(nullptr) : Json(job.paths)},
            {"settings", to_json(job.settings)},
            {"priority", job.priority},
            {"first_frame", job.frames.first},
            {"last_frame", job.frames.last},
            {"frames_per_second", job.frames_per_second},
            {"revision", job.revision()},
            {"reused", job.edits.empty() ? Json(nullptr) : or_null(job.edits.back().reused)},
            {"frames_done", job.frames_done},
            {"stale_frames", job.stale_frames},
            {"progress", job.progress},
            {"doing", job.doing},
            {"remaining_s", job.remaining ? Json(job.remaining->count()) : Json(nullptr)},
            {"created", to_rfc3339(job.created)},
            {"started", time_or_null(job.started)},
            {"ended", time_or_null(job.ended)},
            {"frames_removed", time_or_null(job.frames_removed)},
            {"error", job.error ? to_json(*job.error) : Json(nullptr)},
            {"warnings", to_json(job.warnings)},
            {"statistics", to_json(job.statistics)}};
}

std::string picture_url(const std::string& job, const FrameInfo& info, PictureType type) {
    return "/v1/jobs/" + job + "/frames/" + std::to_string(info.frame) +
           "/image?type=" + (type == PictureType::png ? "png" : "exr") +
           "&rev=" + std::to_string(info.revision);
}

Json frame_json(const Job& job, const FrameInfo& info) {
    return {{"frame", info.frame},
            {"revision", info.revision},
            {"job_revision", info.job_revision},
            {"final", info.final},
            {"stale", job.is_stale(info)},
            {"residual", info.residual},
            {"error_bound", or_null(info.error_bound)},
            {"picture_error", or_null(info.picture_error)},
            {"png", picture_url(job.id, info, PictureType::png)},
            {"exr", picture_url(job.id, info, PictureType::exr)}};
}

Json image_json(const Job& job, const FrameInfo& info) {
    return {{"frame", info.frame},
            {"revision", info.revision},
            {"job_revision", info.job_revision},
            {"stale", job.is_stale(info)},
            {"url", picture_url(job.id, info, PictureType::png)},
            {"exr", picture_url(job.id, info, PictureType::exr)},
            {"residual", info.residual},
            {"error_bound", or_null(info.error_bound)},
            {"picture_error", or_null(info.picture_error)},
            {"final", info.final}};
}

}  // namespace afterglow
