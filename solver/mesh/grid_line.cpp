#include "solver/mesh/grid_line.h"

#include <algorithm>

namespace afterglow {

namespace {

float cross(const Vec2& a, const Vec2& b) {
    return a.x * b.y - a.y * b.x;
}

}  // namespace

GridLine line_through(const Vec2& a, const Vec2& b, const Vec2& cell_m) {
    const Vec2 along = glm::normalize(cell_m * (b - a));
    return {a, Vec2(-along.y, along.x) * cell_m};
}

std::optional<GridSegment> clip(const GridSegment& segment, const Vec2& low, const Vec2& high) {
    const Vec2 along = segment.to - segment.from;
    float first = 0, last = 1;
    for (int axis = 0; axis < 2; ++axis) {
        const float from = segment.from[axis], step = along[axis];
        if (step == 0) {
            if (from < low[axis] || from > high[axis]) return std::nullopt;
            continue;
        }
        const auto [enter, leave] = std::minmax({(low[axis] - from) / step, (high[axis] - from) / step});
        first = std::max(first, enter);
        last = std::min(last, leave);
    }
    if (first > last) return std::nullopt;
    return GridSegment{segment.at(first), segment.at(last)};
}

bool crosses(const GridSegment& segment, const Vec2& a, const Vec2& b) {
    const Vec2 along = segment.to - segment.from, way = b - a;
    if (cross(along, a - segment.from) * cross(along, b - segment.from) > 0) return false;
    return cross(way, segment.from - a) * cross(way, segment.to - a) <= 0;
}

}  // namespace afterglow
