#pragma once

#include <span>

#include "solver/formfactor/outside_light.h"
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

}  // namespace afterglow
