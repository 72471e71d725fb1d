#pragma once

#include <optional>

#include "solver/base/math.h"

namespace afterglow {

/// A straight line across the grid of a surface.
struct GridLine {
    Vec2 through{0};  ///< a place on it, cell coordinates
    Vec2 normal{0};   ///< scaled so that `distance` is in metres, whatever the shape of the cells

    /// Signed, metres: above 0 on the side that `normal` points to.
    [[nodiscard]] float distance(const Vec2& cell) const { return glm::dot(cell - through, normal); }
};

/// The line through two different places; `cell_m` is the size of a cell, metres.
GridLine line_through(const Vec2& a, const Vec2& b, const Vec2& cell_m);

/// Part of a straight line in cell coordinates.
struct GridSegment {
    Vec2 from{0}, to{0};

    [[nodiscard]] Vec2 at(float t) const { return from + t * (to - from); }
};

/// The part within a rectangle; none where it misses. Source: Liang and Barsky 1984. Thread-safety: pure.
std::optional<GridSegment> clip(const GridSegment& segment, const Vec2& low, const Vec2& high);

/// Whether the way from `a` to `b` meets the segment. A way that begins or ends on its line counts as
/// crossing that line. Thread-safety: pure.
bool crosses(const GridSegment& segment, const Vec2& a, const Vec2& b);

}  // namespace afterglow
