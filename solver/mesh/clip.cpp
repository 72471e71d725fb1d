#include "solver/mesh/clip.h"

namespace afterglow {

namespace {

/// `distance` is above 0 where a corner is kept; `settle` has the last word on corners that clipping makes.
template <class Distance, class Settle>
ClipPolygon clip_by(const ClipPolygon& polygon, const Distance& distance, const Settle& settle) {
    ClipPolygon out;
    out.triangle = polygon.triangle;
    for (int i = 0; i < polygon.count; ++i) {
        const ClipCorner& a = polygon[i];
        const ClipCorner& b = polygon[(i + 1) % polygon.count];
        const float da = distance(a.cell), db = distance(b.cell);
        if (da >= 0) out.add(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            const float t = da / (da - db);
            ClipCorner crossing{glm::mix(a.cell, b.cell, t), glm::mix(a.barycentric, b.barycentric, t)};
            settle(crossing.cell);
            out.add(crossing);
        }
    }
    return out;
}

}  // namespace

ClipPolygon clip(const ClipPolygon& polygon, int axis, float bound, Keep keep) {
    const float sign = keep == Keep::above ? 1.0F : -1.0F;
    // Exactly on the line, so that the next square's clipping finds it there.
    return clip_by(
        polygon, [&](const Vec2& cell) { return sign * (cell[axis] - bound); },
        [&](Vec2& cell) { cell[axis] = bound; });
}

ClipPolygon clip(const ClipPolygon& polygon, const GridLine& line, float away_m, Keep keep) {
    const float sign = keep == Keep::above ? 1.0F : -1.0F;
    return clip_by(
        polygon, [&](const Vec2& cell) { return sign * line.distance(cell) - away_m; }, [](Vec2&) {});
}

ClipPolygon clip_to_square(const ClipPolygon& polygon, const Vec2& low, float size) {
    ClipPolygon part = polygon;
    for (int axis = 0; axis < 2; ++axis) {
        part = clip(part, axis, low[axis], Keep::above);
        if (part.count < 3) return part;
        part = clip(part, axis, low[axis] + size, Keep::below);
        if (part.count < 3) return part;
    }
    return part;
}

}  // namespace afterglow
