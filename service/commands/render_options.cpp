#include "service/commands/render_options.h"

#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

#include "service/base/option_values.h"
#include "solver/base/error.h"

namespace afterglow {

namespace {

using Text = std::optional<std::string>;

/// The options as they were typed; absent where not given.
struct Typed {
    std::string scene;
    Text paths, frames, fps, size, quality, method, visibility, solution, rays, patch_size, error, camera,
        threads, seed, out, report, background, estimate, unit, up, punctual_lights, exposure, cache;
    bool quiet = false;
};

void declare_options(CLI::App& app, Typed& typed) {
    app.add_option("SCENE", typed.scene, "Scene to render: .glb, .gltf, .obj or .json")->required();
    app.add_option("--paths", typed.paths, "Paths document (.json) that adds or replaces motion");
    app.add_option("--frames", typed.frames, "Frames A-B, both included, or one frame A [all]");
    app.add_option("--fps", typed.fps, "Frames a second: frame n shows time n/fps [the scene's]");
    app.add_option("--size", typed.size, "Picture size WxH in pixels [640x360]");
    app.add_option("--quality", typed.quality, "draft, preview or final [preview]");
    app.add_option("--method", typed.method, "Named method, sets both --visibility and --solution");
    app.add_option("--visibility", typed.visibility, "How a frame learns what its sight lines see");
    app.add_option("--solution", typed.solution, "How a frame's light is solved");
    app.add_option("--rays", typed.rays, "Sight lines a patch, 16 to 65536 [by quality]");
    app.add_option("--patch-size", typed.patch_size,
                   "Patch edge in metres, even everywhere [by quality and scene]");
    app.add_option("--error", typed.error,
                   "Asked relative error of the pictures, 0.02 or 2%: settles what --quality would; with\n"
                   "--rays or --patch-size, the solution's certificate only [by quality]");
    app.add_option("--estimate", typed.estimate, "Of each picture's error: none or probes [none]");
    app.add_option("--camera", typed.camera, "Camera by name [the first]");
    app.add_option("--exposure", typed.exposure,
                   "Stops of the .png pictures [automatic, from the first frame]");
    app.add_option("--background", typed.background, "Radiance R,G,B of lines that leave the scene");
    app.add_option("--unit", typed.unit, "Unit of an .obj file: m, cm, mm, in, ft or a number of metres [m]");
    app.add_option("--up", typed.up, "Axis of an .obj file that points up: y or z [y]");
    app.add_option("--punctual-lights", typed.punctual_lights,
                   "Lights without surface: auto, keep or per-683 (divide by 683 lm/W) [auto]");
    app.add_option("--threads", typed.threads, "Threads to work with [one a core]");
    app.add_option("--seed", typed.seed, "Seed of every random choice [1]");
    app.add_option("--cache", typed.cache, "Folder for static rows, or none [~/.cache/afterglow]");
    app.add_option("--out", typed.out, "Folder for frame_NNNN.exr and .png [out]");
    app.add_option("--report", typed.report, "File for figures of time and work (JSON)");
    app.add_flag("--quiet", typed.quiet, "Show no progress");
}

/// The meaning of a word among a few. Errors: invalid_input listing them.
template <class Value>
Value choice(const std::string& place, const std::string& word,
             std::initializer_list<std::pair<std::string_view, Value>> choices) {
    std::string words;
    for (const auto& [name, value] : choices) {
        if (word == name) return value;
        if (!words.empty()) words += ", ";
        words += name;
    }
    throw Error(ErrorKind::invalid_input, place, "expected one of " + words + ", found \"" + word + "\"");
}

/// A path that was given must not be empty: an unset shell variable would otherwise mean "here".
std::filesystem::path path(const std::string& place, const std::string& text) {
    if (text.empty()) throw Error(ErrorKind::invalid_input, place, "the path is empty");
    return text;
}

LoadConfig load_config(const Typed& typed) {
    LoadConfig config;
    if (typed.unit) config.obj_unit_m = unit_in_metres("--unit", *typed.unit);
    if (typed.up) config.obj_up = choice<UpAxis>("--up", *typed.up, {{"y", UpAxis::y}, {"z", UpAxis::z}});
    if (typed.punctual_lights)
        config.lumen_scale = choice<LumenScale>(
            "--punctual-lights", *typed.punctual_lights,
            {{"auto", LumenScale::automatic}, {"keep", LumenScale::keep}, {"per-683", LumenScale::divide}});
    if (typed.background) config.background = linear_colour("--background", *typed.background);
    return config;
}

void set_method(SequenceConfig& config, const Typed& typed) {
    if (typed.method) {
        const Method& method = method_named(*typed.method);
        config.visibility = method.visibility;
        config.solution = method.solution;
    }
    if (typed.visibility) config.visibility = visibility_named(*typed.visibility);
    if (typed.solution) config.solution = solution_named(*typed.solution);
}

SequenceConfig sequence_config(const Typed& typed) {
    SequenceConfig config;
    config.revisions = Revisions::final_only;
    set_method(config, typed);
    if (typed.rays) config.rays_per_patch = static_cast<int>(whole_number("--rays", *typed.rays, 16, 65536));
    if (typed.patch_size) config.patch_size_m = positive_number("--patch-size", *typed.patch_size);
    if (typed.error) config.asked_error = share("--error", *typed.error);
    if (typed.estimate) config.estimate = estimate_named(*typed.estimate);
    if (typed.quality) config.quality = quality_named(*typed.quality);
    if (typed.size) {
        const PictureSize size = picture_size("--size", *typed.size);
        config.width = size.width;
        config.height = size.height;
    }
    if (typed.camera) config.camera = *typed.camera;
    if (typed.fps) config.frames_per_second = decimal_number("--fps", *typed.fps, 0.001, 100000);
    if (typed.exposure) config.exposure_ev = decimal_number("--exposure", *typed.exposure, -64, 64);
    if (typed.seed)
        config.seed = static_cast<std::uint64_t>(
            whole_number("--seed", *typed.seed, 0, std::numeric_limits<std::int64_t>::max()));
    if (!typed.cache)
        config.cache_folder = default_cache_folder();
    else if (*typed.cache != "none")
        config.cache_folder = path("--cache", *typed.cache);
    return config;
}

}  // namespace

std::filesystem::path default_cache_folder() {
    const char* const cache = std::getenv("XDG_CACHE_HOME");
    // The base directory specification says that a relative path there is to be ignored.
    if (cache != nullptr && cache[0] == '/') return std::filesystem::path(cache) / "afterglow";
    const char* const home = std::getenv("HOME");
    if (home != nullptr && home[0] == '/') return std::filesystem::path(home) / ".cache" / "afterglow";
    return {};
}

std::variant<RenderOptions, HelpText> read_render_options(std::span<const char* const> arguments) {
    CLI::App app("Renders the frames of a scene into a folder.", "afterglowd render");
    Typed typed;
    declare_options(app, typed);
    if (const auto help = parse_arguments(app, arguments)) return *help;

    RenderOptions options;
    options.scene = path("SCENE", typed.scene);
    if (typed.paths) options.paths = path("--paths", *typed.paths);
    if (typed.frames) options.frames = frame_range("--frames", *typed.frames);
    options.load = load_config(typed);
    options.sequence = sequence_config(typed);
    if (typed.out) options.out = path("--out", *typed.out);
    if (typed.report) options.report = path("--report", *typed.report);
    if (typed.threads) options.threads = static_cast<int>(whole_number("--threads", *typed.threads, 1, 1024));
    if (typed.quiet) options.progress = RenderOptions::Progress::hidden;
    return options;
}

}  // namespace afterglow
