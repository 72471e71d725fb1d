#pragma once

#include <cstdint>
#include <vector>

#include "solver/base/pixels.h"

namespace afterglow {

/// A pixel whose error is looked at for those of many others.
struct Probe {
    int x = 0, y = 0;
    double weight = 1;       ///< over those of pixels chosen evenly, at most 2: means must be weighted by it
    std::uint64_t seed = 0;  ///< its own, also where a pixel is chosen twice
};

/// Chooses `count` pixels of a picture (all of one that has no more): half of them by chance alone, half by
/// how much the picture changes around, since that is where its errors are. Weighted means over them are on
/// average those over the picture. They are spread along a curve through the picture, not just drawn. Same
/// choice for the same seed. Thread-safety: pure. Source: importance sampling with a defensive mixture,
/// Hesterberg 1995.
std::vector<Probe> choose_probes(const Picture& picture, int count, std::uint64_t seed);

}  // namespace afterglow
