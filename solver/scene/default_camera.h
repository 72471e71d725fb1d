#pragma once

#include "solver/base/math.h"
#include "solver/scene/scene.h"
#include "solver/scene/world.h"

namespace afterglow {

/// The rotation of a camera at `from` that looks at `to` (its −z points there) with its y as near to `up` as
/// can be. `from` and `to` differ; where `up` is parallel to the line between them another axis is taken.
Quat looking_at(const Vec3& from, const Vec3& to, const Vec3& up = Vec3(0, 1, 0));

/// Adds a camera node that shows the whole of `world`, which is `scene` assembled and has triangles: from an
/// upper corner of a closed room, or else from outside, in front of and a little above it.
void add_default_camera(Scene& scene, const World& world);

}  // namespace afterglow
