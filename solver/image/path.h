#pragma once

#include <cstdint>
#include <span>

#include "solver/base/context.h"
#include "solver/base/pixels.h"
#include "solver/base/sampling.h"
#include "solver/formfactor/outside_light.h"
#include "solver/image/camera.h"
#include "solver/image/direct_light.h"

// Path tracing: the light of a scene without patches. It is slow and noisy but right on average, so it tells
// how far a picture made from patches is off.

namespace afterglow {

/// A scene at one time. Everything pointed at belongs to the caller.
struct PathScene {
    const World* world = nullptr;
    const RayCaster* caster = nullptr;    ///< with the bodies where they stand
    std::span<const Material> materials;  ///< as they are at this time
    /// Lamps that are sampled from every point; all other shining surfaces count where a path meets them.
    /// Null: no lamp is sampled. The mean is the same for any choice; the noise is not.
    const DirectLight* direct = nullptr;
    std::span<const LightInPlace> lights;  ///< lights without a surface
    float lift_m = 0;                      ///< of rays off the surface they start on, see SightLines::lift_m
};

/// How paths end.
struct PathConfig {
    /// Reflections before a path may end by chance. After them it goes on with the probability of the
    /// surface's reflectance, its largest channel, which leaves the mean unchanged.
    int sure_bounces = 3;
    /// Reflections after which a path ends in any case. Only a guard: at a reflectance of 0.99 what it cuts
    /// off is 1e-18 of the light.
    int most_bounces = 4096;
};

/// What a ray of a path meets: a surface, ready for rays to start, or the background.
struct PathPoint {
    Rgb emitted{0};      ///< radiance towards where the ray came from, W/m²/sr
    Rgb reflectance{0};  ///< 0: the path ends here
    Vec3 position{0};    ///< lifted off the surface, world, metres
    Vec3 normal{0};      ///< unit, on the side that was met
    enum class Light { met, sampled } light = Light::met;  ///< sampled: it belongs to a lamp of `direct`
};

/// Follows a ray to the first thing it meets. Adds one to `rays_traced`. Thread-safety: pure but for that.
PathPoint follow(const PathScene& scene, const Ray& ray, std::uint64_t& rays_traced);

/// Places on the lamps, each number in [0,1): which lamp, and where on it.
struct LampChoice {
    float choice = 0, s = 0, t = 0;
};

/// An unbiased estimate of the irradiance, W/m², that a point gets straight from `direct` and `lights`: one
/// shadow ray to the chosen place of the lamps, one to each light. Adds the number of rays to `rays_traced`.
/// Thread-safety: pure but for that.
Rgb sampled_irradiance(const PathScene& scene, const PathPoint& at, const LampChoice& lamp,
                       std::uint64_t& rays_traced);

/// An unbiased estimate of the radiance, W/m²/sr, that arrives at a ray's origin from its direction: emission
/// and background as met, light from lamps and lights at every point by one shadow ray each, diffuse
/// reflection by cosine-weighted bounces. Adds the number of rays to `rays_traced`. Source: Kajiya 1986, with
/// Arvo and Kirk's Russian roulette 1990. Thread-safety: pure but for `random` and `rays_traced`.
Rgb path_radiance(const PathScene& scene, const PathConfig& config, const Ray& ray, RandomStream& random,
                  std::uint64_t& rays_traced);

/// The same for a ray that leaves a surface whose light by `sampled_irradiance` is taken apart: lamps that
/// the ray meets first do not count.
Rgb gathered_radiance(const PathScene& scene, const PathConfig& config, const Ray& ray, RandomStream& random,
                      std::uint64_t& rays_traced);

struct PathPictureConfig {
    int samples_per_pixel = 64;  ///< independent paths a pixel, box-filtered; 2 or more
    std::uint64_t seed = 1;      ///< of all paths
    PathConfig path = {};        ///< see PathConfig
};

/// A path-traced picture and how noisy it is.
struct PathPicture {
    Picture mean;      ///< radiance, W/m²/sr
    Picture variance;  ///< of each pixel's mean, an unbiased estimate, by channel
};

/// One pixel: radiance and variance as in PathPicture. The same bits as in the whole picture.
struct PathPixel {
    Rgb mean{0};
    Rgb variance{0};
};
PathPixel trace_pixel(const CameraView& view, const PathScene& scene, const PathPictureConfig& config, int x,
                      int y, std::uint64_t& rays_traced);

/// All pixels. Every sample has a random stream of its own that follows from the seed, the pixel and the
/// sample's number: same bits for any number of threads. Adds the number of rays to `rays_traced`. Errors:
/// invalid_input for less than two samples; cancelled.
PathPicture trace_picture(const CameraView& view, const PathScene& scene, const PathPictureConfig& config,
                          std::uint64_t& rays_traced, const Context& context);

}  // namespace afterglow
