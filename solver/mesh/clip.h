#pragma once

#include <array>

#include "solver/base/math.h"
#include "solver/mesh/grid_line.h"

namespace afterglow {

/// A corner of a clipped triangle: where in the grid of its surface, and where in the triangle.
struct ClipCorner {
    Vec2 cell;         ///< cell coordinates
    Vec3 barycentric;  ///< of the triangle
};

/// What clipping leaves of a triangle: convex. Each clipping line adds at most one corner; division into
/// quarters clips to nested squares, so no more than seven stand, and cuts add CellTree::most_splits and one.
struct ClipPolygon {
    std::array<ClipCorner, 26> corners;
    int count = 0;
    Index triangle = no_index;  ///< of the body

    void add(const ClipCorner& c) { corners[static_cast<std::size_t>(count++)] = c; }
    [[nodiscard]] const ClipCorner& operator[](int i) const { return corners[static_cast<std::size_t>(i)]; }
};

/// Which part of the plane clipping keeps.
enum class Keep { below, above };

/// The part of a polygon where coordinate `axis` (0 or 1) is on the kept side of `bound`. Source: Sutherland
/// and Hodgman 1974. Thread-safety: pure.
ClipPolygon clip(const ClipPolygon& polygon, int axis, float bound, Keep keep);

/// The part on the kept side of a line and farther than `away_m` from it.
ClipPolygon clip(const ClipPolygon& polygon, const GridLine& line, float away_m, Keep keep);

/// The part within a square of the grid.
ClipPolygon clip_to_square(const ClipPolygon& polygon, const Vec2& low, float size);

}  // namespace afterglow
