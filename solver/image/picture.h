#pragma once

#include <algorithm>
#include <cstdint>

#include "solver/base/context.h"
#include "solver/base/pixels.h"
#include "solver/image/camera.h"
#include "solver/image/lit_world.h"

namespace afterglow {

struct PictureConfig {
    int samples_per_pixel = 4;        ///< camera rays of every pixel, 1 or more, box-filtered
    int most_samples_per_pixel = 32;  ///< of pixels whose first samples meet several surfaces or disagree
    int light_samples_per_point = 2;  ///< shadow rays to lamps from what each camera ray meets
    /// Standard error of a pixel's first samples, relative to its mean, above which it gets the most samples.
    float noise = 0.03F;
    std::uint64_t seed = 1;  ///< of the places of the samples within pixels and on lamps

    bool operator==(const PictureConfig&) const = default;
};

/// Samples of a noisy pixel in all.
inline std::size_t most_samples(const PictureConfig& config) {
    return static_cast<std::size_t>(std::max(config.samples_per_pixel, config.most_samples_per_pixel));
}

/// What `lit.irradiance` is, interpolated, where a ray meets a surface, W/m². Thread-safety: pure.
Rgb interpolated_irradiance(const LitWorld& lit, const Ray& ray, const Hit& hit);

/// Radiance seen by a camera: what a surface emits, and its reflectance at the point (texture included) times
/// the irradiance over π. Pixels that need them get more samples than the others (Mitchell 1987). Adds the
/// number of rays to `rays_traced`. Same bits for any number of threads. Errors: cancelled.
Picture render_picture(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                       std::uint64_t& rays_traced, const Context& context);

}  // namespace afterglow
