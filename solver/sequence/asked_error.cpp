#include "solver/sequence/asked_error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace afterglow {

namespace {

/// What was measured to keep an error. Numbers that count things are interpolated before they are rounded.
struct Measured {
    double error;
    float cells, finest_share, size_per_distance;
    float rays;
    float samples, most_samples, light_samples, noise;
    float probe_parts, probe_samples, probe_paths;
};

// The largest error first. Of the two kinds of noise that of pixels is the dearer: lines are fewer and
// samples more than in the quality of the same error.
constexpr std::array<Measured, 6> measured{{
    {coarsest_error, 1000, 1.000F, 0.7F, 64, 2, 8, 2, 0.100F, 16, 8, 2},
    {0.05, 1000, 0.250F, 0.7F, 96, 4, 12, 2, 0.080F, 16, 8, 2},
    {0.03, 1500, 0.125F, 0.7F, 128, 4, 24, 2, 0.050F, 16, 16, 3},
    {0.02, 2200, 0.125F, 0.7F, 256, 8, 32, 2, 0.030F, 16, 16, 3},
    {0.01, 9000, 0.125F, 1.0F, 512, 12, 64, 4, 0.020F, 24, 32, 4},
    {finest_promised_error, 12000, 0.125F, 1.0F, 1024, 16, 128, 4, 0.012F, 24, 32, 4},
}};
// Beyond the last of them patches and samples grow down to this error and no further: memory and time go with
// its inverse square.
constexpr double finest_tried_error = 0.005;

// Of the pictures that all of this was measured with; and what the samples of pixels with edges grow by at
// most in smaller ones.
constexpr double measured_pixels = 256.0 * 256.0;
constexpr double most_edge_growth = 4;

/// How many more samples pixels with edges need than in a picture of the measured size. Their squared error
/// goes with the inverse of their samples, and their share of the picture with the inverse of its edge.
float edge_growth(double pixels) {
    return static_cast<float>(std::clamp(std::sqrt(measured_pixels / pixels), 1.0, most_edge_growth));
}

/// A power law through two values; `t` is 0 at the first and 1 at the second.
float between(float first, float second, double t) {
    return static_cast<float>(first * std::pow(static_cast<double>(second) / first, t));
}

int whole_between(float first, float second, double t) {
    return static_cast<int>(std::lround(between(first, second, t)));
}

}  // namespace

bool error_settles_all(const SequenceConfig& config) {
    return config.asked_error && !config.rays_per_patch && !config.patch_size_m;
}

QualityLevel level_for_error(double asked, double pixels) {
    const double error = std::clamp(asked, finest_tried_error, coarsest_error);
    std::size_t k = 1;
    while (k + 1 < measured.size() && error < measured[k].error) ++k;
    const Measured& a = measured[k - 1];
    const Measured& b = measured[k];
    const double t = std::log(error / a.error) / std::log(b.error / a.error);

    QualityLevel level;
    level.cells = between(a.cells, b.cells, t);
    level.finest_share = between(a.finest_share, b.finest_share, t);
    level.size_per_distance = between(a.size_per_distance, b.size_per_distance, t);
    level.rays_per_patch = whole_between(a.rays, b.rays, t);
    level.certificate = asked;
    level.picture_tolerance = static_cast<float>(0.1 * error);
    level.picture.samples_per_pixel = whole_between(a.samples, b.samples, t);
    const float growth = edge_growth(pixels);
    level.picture.most_samples_per_pixel = whole_between(growth * a.most_samples, growth * b.most_samples, t);
    level.picture.light_samples_per_point = whole_between(a.light_samples, b.light_samples, t);
    level.picture.noise = between(a.noise, b.noise, t);
    level.probes.parts = whole_between(a.probe_parts, b.probe_parts, t);
    level.probes.samples_per_part = whole_between(a.probe_samples, b.probe_samples, t);
    level.probes.paths_per_sample = whole_between(a.probe_paths, b.probe_paths, t);
    return level;
}

}  // namespace afterglow
