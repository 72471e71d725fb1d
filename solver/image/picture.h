#pragma once

#include <cstdint>
#include <span>

#include "solver/base/context.h"
#include "solver/base/pixels.h"
#include "solver/formfactor/outside_light.h"
#include "solver/image/camera.h"
#include "solver/image/direct_light.h"
#include "solver/mesh/interpolation.h"
#include "solver/mesh/smooth_normals.h"

namespace afterglow {

/// What a picture is made from, at one time.
struct LitWorld {
    const World* world = nullptr;
    const PatchMesh* mesh = nullptr;
    const Interpolation* interpolation = nullptr;
    const SmoothNormals* normals = nullptr;
    const RayCaster* caster = nullptr;    ///< with the bodies where they stand
    std::span<const Material> materials;  ///< as they are at this time
    /// By patch, W/m², interpolated: all of it, or what `direct` and `lights` do not bring.
    std::span<const Rgb> irradiance;
    std::span<const float> confidence;  ///< by patch: share of its lines that were of use
    /// Lamps whose light is taken point by point, with shadows as sharp as they are; null: none.
    const DirectLight* direct = nullptr;
    std::span<const LightInPlace> lights;  ///< likewise, lights without a surface
    float lift_m = 0;                      ///< of shadow rays off their surface
};

struct PictureConfig {
    int samples_per_pixel = 4;        ///< camera rays of every pixel, 1 or more, box-filtered
    int most_samples_per_pixel = 32;  ///< of pixels whose first samples meet several surfaces or disagree
    int light_samples_per_point = 2;  ///< shadow rays to lamps from what each camera ray meets
    /// Standard error of a pixel's first samples, relative to its mean, above which it gets the most samples.
    float noise = 0.03F;
    std::uint64_t seed = 1;  ///< of the places of the samples within pixels and on lamps
};

/// What `lit.irradiance` is, interpolated, where a ray meets a surface, W/m². Thread-safety: pure.
Rgb interpolated_irradiance(const LitWorld& lit, const Ray& ray, const Hit& hit);

/// Radiance seen by a camera: what a surface emits, and its reflectance at the point (texture included) times
/// the irradiance over π. Pixels that need them get more samples than the others (Mitchell 1987). Adds the
/// number of rays to `rays_traced`. Same bits for any number of threads. Errors: cancelled.
Picture render_picture(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                       std::uint64_t& rays_traced, const Context& context);

}  // namespace afterglow
