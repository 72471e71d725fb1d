#include "solver/image/shadow_region.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace afterglow {

namespace {

std::array<Vec2, 4> corners_of(const Box& box, int i, int j) {
    return {Vec2(box.low[i], box.low[j]), Vec2(box.high[i], box.low[j]), Vec2(box.low[i], box.high[j]),
            Vec2(box.high[i], box.high[j])};
}

}  // namespace

ShadowRegion::ShadowRegion(const Box& blocker, const Box& light, float slack_m) {
    const Box grown{blocker.low - slack_m, blocker.high + slack_m};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 along(0);
        along[axis] = 1;
        if (light.low[axis] >= grown.high[axis]) planes_.push_back({along, grown.high[axis]});
        if (light.high[axis] <= grown.low[axis]) planes_.push_back({-along, -grown.low[axis]});
        add_tangents(grown, light, axis, (axis + 1) % 3);
    }
}

void ShadowRegion::add_tangents(const Box& blocker, const Box& light, int i, int j) {
    const auto of_blocker = corners_of(blocker, i, j), of_light = corners_of(light, i, j);
    for (const Vec2& b : of_blocker) {
        for (const Vec2& l : of_light) {
            const Vec2 along = l - b;
            const float length = std::sqrt(along.x * along.x + along.y * along.y);
            if (!(length > 0)) continue;
            for (const float sign : {-1.0F, 1.0F}) {
                const Vec2 normal = sign / length * Vec2(-along.y, along.x);
                const auto beyond = [&](const Vec2& c) {
                    return normal.x * (c.x - b.x) + normal.y * (c.y - b.y);
                };
                float blocker_end = 0, light_begin = 0;
                for (const Vec2& c : of_blocker) blocker_end = std::max(blocker_end, beyond(c));
                for (const Vec2& c : of_light) light_begin = std::min(light_begin, beyond(c));
                const float rounding = 1e-6F * length;
                if (blocker_end > rounding || light_begin < -rounding) continue;
                Plane plane;
                plane.normal[i] = normal.x;
                plane.normal[j] = normal.y;
                plane.offset = normal.x * b.x + normal.y * b.y + blocker_end;
                planes_.push_back(plane);
            }
        }
    }
}

bool ShadowRegion::holds(const Vec3& point) const {
    return std::none_of(planes_.begin(), planes_.end(),
                        [&](const Plane& p) { return glm::dot(p.normal, point) > p.offset; });
}

bool ShadowRegion::meets(const Box& points) const {
    if (points.empty()) return false;
    const Vec3 centre = points.centre(), reach = 0.5F * points.extent();
    return std::none_of(planes_.begin(), planes_.end(), [&](const Plane& p) {
        return glm::dot(p.normal, centre) - glm::dot(glm::abs(p.normal), reach) > p.offset;
    });
}

}  // namespace afterglow
