#pragma once

#include "solver/scene/scene.h"

namespace afterglow {

/// What a channel of 1 or more becomes where that is harmless.
inline constexpr float largest_reflectance = 0.99F;

/// Brings every reflectance, of materials and of their tracks, below 1. `scene` is otherwise valid.
/// Where light can leave the scene, or where a texture darkens the material, channels of 1 or more become
/// `largest_reflectance` with one warning that names the materials. In a closed scene an untextured surface
/// that absorbs nothing would let the light grow for ever:
/// Errors: cannot_converge naming the material. Closed means: from just in front of the first emitter (or
/// else the first light or camera) every direction tried meets a surface; see `is_enclosed`.
void limit_reflectance(Scene& scene);

}  // namespace afterglow
