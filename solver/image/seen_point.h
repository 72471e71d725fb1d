#pragma once

#include "solver/image/lit_world.h"

namespace afterglow {

/// What a camera ray meets, as far as light is concerned.
struct SeenPoint {
    Rgb emitted{0};            ///< radiance, W/m²/sr
    Rgb reflectance{0};        ///< texture included; 0: no light need be taken
    Vec3 position{0};          ///< lifted off the surface, world
    Vec3 normal{0};            ///< unit, on the side that is seen
    Index surface = no_index;  ///< twice its number, and its side; nothing: no_index
    Stencil stencil;           ///< patches whose irradiance makes up what is interpolated; may be empty

    [[nodiscard]] bool takes_light() const { return max_channel(reflectance) > 0; }
};

/// `hit` is what the ray meets first, bodies standing where the caster has them. Thread-safety: pure.
SeenPoint look_at(const LitWorld& lit, const Ray& ray, const Hit& hit);

/// Unit normal for shading where a ray met a surface, on the side that is seen. Thread-safety: pure.
Vec3 shading_normal(const LitWorld& lit, const Hit& hit);

}  // namespace afterglow
