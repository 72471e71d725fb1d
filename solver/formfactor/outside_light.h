#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/formfactor/rows.h"
#include "solver/scene/world.h"

namespace afterglow {

/// A light without surface, and where it is at one time.
struct LightInPlace {
    Light light;
    Pose pose;
};
std::vector<LightInPlace> lights_at(const World& world, double time_s);

/// Irradiance of all patches, W/m², from the uniform background, by each patch's share of sky.
std::vector<Rgb> sky_irradiance(const World& world, std::span<const float> sky);

/// Irradiance of all patches, W/m², from lights without a surface, by several points of each patch with
/// shadow rays against everything the caster has placed. `valid_share` by patch, as in FormFactors. Adds the
/// number of rays to `rays_traced`. Errors: cancelled.
std::vector<Rgb> light_irradiance(std::span<const LightInPlace> lights, const PatchMesh& mesh,
                                  const SightLines& lines, const RayCaster& placed,
                                  std::span<const float> valid_share, std::uint64_t& rays_traced,
                                  const Context& context);

/// Irradiance that a light without surface gives a point if nothing stands between, and the way to it.
struct LightAtPoint {
    Rgb irradiance{0};     ///< W/m², on a surface with the given normal
    Vec3 direction{0};     ///< unit, towards the light
    float distance_m = 0;  ///< infinite for directional lights
};
LightAtPoint light_at(const Light& light, const Pose& pose, const Vec3& point, const Vec3& normal);

}  // namespace afterglow
