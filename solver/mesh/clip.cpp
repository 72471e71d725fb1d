#include "solver/mesh/clip.h"

namespace afterglow {

ClipPolygon clip(const ClipPolygon& polygon, int axis, float bound, Keep keep) {
    const float sign = keep == Keep::above ? 1.0F : -1.0F;
    ClipPolygon out;
    out.triangle = polygon.triangle;
    for (int i = 0; i < polygon.count; ++i) {
        const ClipCorner& a = polygon[i];
        const ClipCorner& b = polygon[(i + 1) % polygon.count];
        const float da = sign * (a.cell[axis] - bound);
        const float db = sign * (b.cell[axis] - bound);
        if (da >= 0) out.add(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            const float t = da / (da - db);
            ClipCorner crossing{glm::mix(a.cell, b.cell, t), glm::mix(a.barycentric, b.barycentric, t)};
            // Exactly on the line, so that the next square's clipping finds it there.
            crossing.cell[axis] = bound;
            out.add(crossing);
        }
    }
    return out;
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
