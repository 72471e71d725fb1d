// One cell of the assessment: a scene's frames by one method, in a process of its own. Prints one JSON object
// with CPU times, counts, memory and certificates, and leaves pictures of the frames asked for.
// Usage: sequence_cell SCENE NAME=VALUE…
// Names: visibility, solution, quality, rays, patch_size, error, seed, frames (first-last), size (edge,
// pixels), pictures (folder), every (frames between pictures)

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>

#include "solver/base/file.h"
#include "solver/base/json.h"
#include "solver/scene/load.h"
#include "solver/sequence/sequence.h"
#include "tests/bench/timing.h"

namespace afterglow {
namespace {

/// What the command line says.
class Options {
  public:
    Options(int count, char** arguments) {
        for (int k = 2; k < count; ++k) {
            const std::string text = arguments[k];
            const std::size_t split = text.find('=');
            if (split == std::string::npos) throw std::invalid_argument(text + " is not NAME=VALUE");
            values_[text.substr(0, split)] = text.substr(split + 1);
        }
    }
    [[nodiscard]] std::string text(const std::string& name, const std::string& otherwise = {}) const {
        const auto found = values_.find(name);
        return found == values_.end() ? otherwise : found->second;
    }
    [[nodiscard]] double number(const std::string& name, double otherwise) const {
        const std::string value = text(name);
        return value.empty() ? otherwise : std::stod(value);
    }
    [[nodiscard]] bool has(const std::string& name) const { return values_.contains(name); }

  private:
    std::map<std::string, std::string> values_;
};

SequenceConfig config_of(const Options& options) {
    SequenceConfig config;
    if (options.has("visibility")) config.visibility = visibility_named(options.text("visibility"));
    if (options.has("solution")) config.solution = solution_named(options.text("solution"));
    config.quality = quality_named(options.text("quality", "preview"));
    if (options.has("rays")) config.rays_per_patch = static_cast<int>(options.number("rays", 0));
    if (options.has("patch_size")) config.patch_size_m = options.number("patch_size", 0);
    if (options.has("error")) config.asked_error = options.number("error", 0);
    config.seed = static_cast<std::uint64_t>(options.number("seed", 1));
    config.width = config.height = static_cast<int>(options.number("size", 96));
    config.exposure_ev = 0;
    config.revisions = Revisions::final_only;
    return config;
}

/// First and last frame.
std::pair<int, int> frames_of(const Options& options) {
    const std::string text = options.text("frames", "0-0");
    const std::size_t dash = text.find('-');
    const int first = std::stoi(text);
    return {first, dash == std::string::npos ? first : std::stoi(text.substr(dash + 1))};
}

/// What is kept of every frame, in the order of the frames.
struct Costs {
    std::vector<double> cpu_s, visibility_ms, solve_ms, image_ms, rays, changes, shots, bound;

    void add(double seconds, const FrameStatistics& frame) {
        cpu_s.push_back(seconds);
        visibility_ms.push_back(frame.visibility.count());
        solve_ms.push_back(frame.solve.count());
        image_ms.push_back(frame.image.count());
        rays.push_back(static_cast<double>(frame.rays_traced));
        changes.push_back(static_cast<double>(frame.visibility_changes));
        shots.push_back(static_cast<double>(frame.shots));
        bound.push_back(frame.error_bound);
    }
};

/// Of all frames but the first.
double mean_following(const std::vector<double>& values) {
    if (values.size() < 2) return 0;
    return std::accumulate(values.begin() + 1, values.end(), 0.0) / static_cast<double>(values.size() - 1);
}

double median_following(const std::vector<double>& values) {
    return values.size() < 2 ? 0 : median({values.begin() + 1, values.end()});
}

/// Of this program alone: getrusage counts what whoever started it held, too.
double peak_memory_mb() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == "VmHWM:") {
            double kib = 0;
            status >> kib;
            return kib * 1024 / 1e6;
        }
    return 0;
}

Json row(const SequenceStatistics& job, const Costs& costs, double load_s, double setup_s) {
    const double following_s = std::accumulate(costs.cpu_s.begin() + 1, costs.cpu_s.end(), 0.0);
    return {{"method", job.method},
            {"patches", job.patches},
            {"actor_patches", job.actor_patches},
            {"lines", job.sight_lines},
            {"load_s", load_s},
            {"setup_s", setup_s},
            {"first_s", setup_s + costs.cpu_s.front()},
            {"follow_s", mean_following(costs.cpu_s)},
            {"follow_median_s", median_following(costs.cpu_s)},
            {"total_s", load_s + setup_s + costs.cpu_s.front() + following_s},
            {"ahead_ms", total(job.work_ahead).count()},
            {"static_ms", job.static_pass.count()},
            {"look_ms", median_following(costs.visibility_ms)},
            {"light_ms", median_following(costs.solve_ms)},
            {"picture_ms", median_following(costs.image_ms)},
            {"rays_first", costs.rays.front()},
            {"rays_follow", mean_following(costs.rays)},
            {"changes_follow", mean_following(costs.changes)},
            {"pushes_first", costs.shots.front()},
            {"pushes_follow", mean_following(costs.shots)},
            {"certificate", *std::max_element(costs.bound.begin(), costs.bound.end())},
            {"peak_mb", peak_memory_mb()},
            {"frame_s", costs.cpu_s}};
}

int run(const std::string& scene, const Options& options) {
    const Context one_thread(1);
    World world;
    const double load_s = 1e-3 * ms_of([&] { world = assemble(load_scene(scene)); });
    SequenceConfig config = config_of(options);
    const auto [first, last] = frames_of(options);
    config.frames_expected = last - first + 1;
    const std::filesystem::path pictures = options.text("pictures");
    if (!pictures.empty()) std::filesystem::create_directories(pictures);
    const int every = std::max(1, static_cast<int>(options.number("every", 1)));

    std::optional<SequenceState> state;
    const double setup_s = 1e-3 * ms_of([&] { state = make_state(std::move(world), config, one_thread); });
    Costs costs;
    for (int f = first; f <= last; ++f) {
        Picture made;
        FrameStatistics frame;
        const RevisionSink keep = [&](const Revision& r) { made = r.radiance; };
        const double ms = ms_of([&] { frame = step(*state, f, keep, one_thread); });
        costs.add(1e-3 * ms, frame);
        if (!pictures.empty() && (last - f) % every == 0) {
            char name[32];
            std::snprintf(name, sizeof name, "frame_%04d.exr", f);
            write_file(pictures / name, encode_exr(made));
        }
    }
    std::printf("%s\n", row(state->statistics(), costs, load_s, setup_s).dump().c_str());
    return 0;
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    try {
        if (count < 2) throw std::invalid_argument("usage: sequence_cell SCENE NAME=VALUE…");
        return afterglow::run(arguments[1], afterglow::Options(count, arguments));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "sequence_cell: %s\n", error.what());
        return 1;
    }
}
