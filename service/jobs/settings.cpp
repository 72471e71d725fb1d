#include "service/jobs/settings.h"

#include "service/base/frame_range.h"

namespace afterglow {

namespace {

constexpr double max_fps = 1000;

FrameRange read_frames(const JsonView& field, const Limits& limits) {
    const FrameRange range = frame_range(field.place(), field.as_string());
    if (range.last - range.first >= limits.frames)
        throw Error(ErrorKind::too_large, field.place(),
                    "more frames than the limit of " + std::to_string(limits.frames));
    return range;
}

/// Looks a name up and lets a failure name the field.
template <class Lookup>
auto read_name(const JsonView& field, Lookup lookup) {
    const std::string name = field.as_string();
    try {
        return lookup(name);
    } catch (const Error& e) {
        throw Error(e.kind(), field.place(), e.message());
    }
}

void read_method(const JsonView& settings, SequenceConfig& config) {
    if (const auto field = settings.find("method")) {
        const Method method = read_name(*field, method_named);
        config.visibility = method.visibility;
        config.solution = method.solution;
    }
    if (const auto field = settings.find("visibility"))
        config.visibility = read_name(*field, visibility_named);
    if (const auto field = settings.find("solution")) config.solution = read_name(*field, solution_named);
}

void read_size(const JsonView& settings, SequenceConfig& config, const Limits& limits) {
    if (const auto field = settings.find("width"))
        config.width = static_cast<int>(field->as_integer_in(1, 16'384));
    if (const auto field = settings.find("height"))
        config.height = static_cast<int>(field->as_integer_in(1, 16'384));
    if (std::int64_t{config.width} * config.height > limits.pixels)
        throw Error(ErrorKind::too_large, settings.place(),
                    "width × height is more than the limit of " + std::to_string(limits.pixels) + " pixels");
}

void read_accuracy(const JsonView& settings, SequenceConfig& config) {
    if (const auto field = settings.find("quality")) config.quality = read_name(*field, quality_named);
    if (const auto field = settings.find("rays"))
        config.rays_per_patch = static_cast<int>(field->as_integer_in(16, 65'536));
    if (const auto field = settings.find("patch_size_m"))
        config.patch_size_m = field->as_number_in(1e-4, 1e4);
    if (const auto field = settings.find("error")) config.asked_error = field->as_number_in(1e-9, 0.999);
    if (const auto field = settings.find("estimate")) config.estimate = read_name(*field, estimate_named);
    if (const auto field = settings.find("seed"))
        config.seed = static_cast<std::uint64_t>(field->as_integer_in(0, std::int64_t{1} << 53U));
}

Rgb read_background(const JsonView& field) {
    const Rgb background = field.as_vec3();
    if (background.r < 0 || background.g < 0 || background.b < 0) field.fail("a radiance cannot be negative");
    return background;
}

}  // namespace

JobSettings read_settings(const JsonView& settings, const Limits& limits) {
    settings.allow_only({"frames", "fps", "width", "height", "quality", "method", "visibility", "solution",
                         "rays", "patch_size_m", "error", "estimate", "camera", "seed", "exposure_ev",
                         "background"});
    JobSettings out;
    read_size(settings, out.sequence, limits);
    read_method(settings, out.sequence);
    read_accuracy(settings, out.sequence);
    if (const auto field = settings.find("frames")) out.frames = read_frames(*field, limits);
    if (const auto field = settings.find("fps"))
        out.sequence.frames_per_second = field->as_number_in(1e-3, max_fps);
    if (const auto field = settings.find("camera")) out.sequence.camera = field->as_string();
    if (const auto field = settings.find("exposure_ev"))
        out.sequence.exposure_ev = field->as_number_in(-40, 40);
    if (const auto field = settings.find("background")) out.background = read_background(*field);
    return out;
}

std::optional<int> read_priority(const JsonView& patch) {
    if (!patch.value().is_object()) patch.fail("expected an object");
    patch.allow_only({"priority"});
    const auto field = patch.find("priority");
    if (!field) return std::nullopt;
    return field->value().is_null() ? 0 : static_cast<int>(field->as_integer_in(-10, 10));
}

JobRequest read_job_request(const JsonView& request, const Limits& limits) {
    request.allow_only({"scene", "paths", "settings"});
    JobRequest out;
    out.scene = request.at("scene").as_string();
    if (const auto field = request.find("paths")) out.paths = field->as_string();
    if (const auto field = request.find("settings")) out.settings = read_settings(*field, limits);
    return out;
}

}  // namespace afterglow
