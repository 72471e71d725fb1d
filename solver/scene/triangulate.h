#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/base/math.h"

namespace afterglow {

/// Larger concave polygons are refused: ear clipping takes up to the cube of their corners.
inline constexpr std::size_t max_concave_corners = 1024;

/// A polygon cut into triangles of corner numbers, in the polygon's own order round.
struct Triangulation {
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< corners − 2 of them
    bool is_simple = true;  ///< false where a triangle faces the wrong way, as the outline crosses itself
};

/// Cuts a polygon in space, seen along its mean (Newell) normal: a fan where it is convex, ear clipping
/// where it is not. `corners`: at least three. A polygon without area becomes a fan.
/// Source: Meisters 1975, "Polygons have ears"; normal: Newell, in Sutherland et al. 1974.
/// Errors: too_large for a concave polygon past `max_concave_corners`. Thread-safety: pure.
Triangulation triangulated(const std::vector<Vec3>& corners);

}  // namespace afterglow
