// How much pictures flicker, by method, beside our own path tracer whose seed changes from frame to frame: a
// table for flicker.py. What is true is the mean of two sequences of final quality with other
// seeds, certified to 0.2 %; half of what these two differ by is what their mean flickers itself:
// the row "truth". Usage: flicker SCENE [first frame] [last frame] [edge, pixels] [threads]

#include "tests/support/flicker.h"

#include <cstdio>
#include <cstdlib>
#include <string>

#include "solver/scene/load.h"
#include "solver/sequence/sequence.h"
#include "tests/bench/path_picture.h"

namespace afterglow {
namespace {

using Pictures = std::vector<Picture>;

struct Run {
    World world;
    int first, last, edge;
    Context context;

    [[nodiscard]] int frames() const { return last - first + 1; }
};

Pictures by_sequence(const Run& run, SequenceConfig config) {
    config.width = config.height = run.edge;
    config.exposure_ev = 0;
    config.revisions = Revisions::final_only;
    Pictures all;
    render_sequence(
        run.world, config, run.first, run.last, [&](const Revision& r) { all.push_back(r.radiance); },
        run.context);
    return all;
}

Pictures by_method(const Run& run, const Method& method, Quality quality) {
    SequenceConfig config;
    config.visibility = method.visibility;
    config.solution = method.solution;
    config.quality = quality;
    return by_sequence(run, config);
}

Pictures finest(const Run& run, std::uint64_t seed) {
    SequenceConfig config;
    config.visibility = Visibility::events;
    config.solution = Solution::residual;
    config.quality = Quality::final;
    config.rays_per_patch = 512;
    // Beside a number of lines this is the certificate alone; patches are those of the quality.
    config.asked_error = 2e-3;
    config.picture_tolerance = 0;
    config.seed = seed;
    return by_sequence(run, config);
}

/// One frame by paths alone.
Picture by_paths(const Run& run, int frame, int samples) {
    std::uint64_t rays = 0;
    const auto seed = 1 + static_cast<std::uint64_t>(frame);
    return path_picture(run.world, frame / run.world.frames_per_second, run.edge, samples, seed, rays,
                        run.context)
        .mean;
}

void print(const std::string& scene, const std::string& quality, std::string_view name,
           std::span<const Picture> shown, std::span<const Picture> truth, double scale = 1) {
    std::printf("%s,%s,%.*s,%.6g,%.6g\n", scene.c_str(), quality.c_str(), static_cast<int>(name.size()),
                name.data(), scale * testing::flicker(shown, truth, 1),
                scale * testing::flicker(shown, truth, 8));
    std::fflush(stdout);
}

void chart(const std::string& scene, const Run& run) {
    std::printf("scene,quality,method,pixels,blocks\n");
    const Pictures one = finest(run, 11), other = finest(run, 12);
    Pictures truth = one;
    for (std::size_t f = 0; f < truth.size(); ++f)
        for (std::size_t k = 0; k < truth[f].pixels.size(); ++k)
            truth[f].pixels[k] = 0.5F * (one[f].pixels[k] + other[f].pixels[k]);
    print(scene, "truth", "truth", one, other, 0.5);
    for (const Quality quality : {Quality::draft, Quality::preview})
        for (const Method& method : methods())
            if (method.visibility != Visibility::automatic)
                print(scene, quality == Quality::draft ? "draft" : "preview", method.name,
                      by_method(run, method, quality), truth);
    for (const int samples : {16, 64, 256}) {
        Pictures traced;
        for (int f = run.first; f <= run.last; ++f) traced.push_back(by_paths(run, f, samples));
        print(scene, "paths", "paths-" + std::to_string(samples), traced, truth);
    }
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    using namespace afterglow;
    if (count < 2) {
        std::fprintf(stderr, "usage: flicker SCENE [first frame] [last frame] [edge, pixels] [threads]\n");
        return 2;
    }
    const auto option = [&](int k, int otherwise) { return count > k ? std::atoi(arguments[k]) : otherwise; };
    const std::string scene = arguments[1];
    const Run run{assemble(load_scene(std::string(AFTERGLOW_TEST_DATA "/") + scene + ".glb")), option(2, 4),
                  option(3, 27), option(4, 96), Context(option(5, 1))};
    chart(scene, run);
}
