#pragma once

#include "solver/scene/world.h"
#include "solver/visibility/ray_caster.h"

// What a surface does with light where a ray meets it.

namespace afterglow {

/// Reflectance at a hit: the material's, times its texture at that point. Each channel in [0, 1).
/// `material` is that of the triangle, as it is at this time. Thread-safety: pure.
Rgb reflectance_at(const World& world, const Material& material, const Hit& hit);

/// Radiance that a side of a surface emits of itself, W/m²/sr. Thread-safety: pure.
Rgb emitted_by(const Material& material, Side side);

/// Unit normal of the side that a ray met, in world coordinates. Thread-safety: pure.
Vec3 normal_at(const World& world, const RayCaster& placed, const Hit& hit);

}  // namespace afterglow
