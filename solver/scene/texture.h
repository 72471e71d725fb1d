#pragma once

#include <cstdint>

#include "solver/scene/scene.h"

namespace afterglow {

/// Linear value in [0, 1] of an 8-bit sRGB code. Source: IEC 61966-2-1. Thread-safety: pure.
float linear_from_srgb(std::uint8_t code);

/// Mean linear colour of all texels; white for an empty texture. Thread-safety: pure.
Rgb mean_colour(const Texture& texture);

}  // namespace afterglow
