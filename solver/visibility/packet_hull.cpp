#include "solver/visibility/packet_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace afterglow {

namespace {

// What rounding may take off a distance in the hull, as a share of it.
constexpr float margin = 1e-5F;

struct Range {
    float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();
};

/// Where lanes with any length begin and end along one axis of the world.
struct Ends {
    Range begin, end;
};
Ends ends_along(const std::array<float, 16>& origin, const std::array<float, 16>& direction,
                const std::array<float, 16>& far, float reach_m) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Ends out;
    for (std::size_t l = 0; l < 16; ++l) {
        const bool counts = far[l] > 0;
        const float from = origin[l], to = from + std::min(far[l], reach_m) * direction[l];
        out.begin.low = std::min(out.begin.low, counts ? from : infinity);
        out.begin.high = std::max(out.begin.high, counts ? from : -infinity);
        out.end.low = std::min(out.end.low, counts ? to : infinity);
        out.end.high = std::max(out.end.high, counts ? to : -infinity);
    }
    return out;
}

}  // namespace

PacketHull::PacketHull(const RayPacket& rays, float reach_m) {
    std::array<float, 16> far = rays.far;
    float furthest = 0;
    for (std::size_t l = rays.count; l < 16; ++l) far[l] = 0;
    for (std::size_t l = 0; l < rays.count; ++l)
        furthest = std::max(
            {furthest, std::abs(rays.origin_x[l]), std::abs(rays.origin_y[l]), std::abs(rays.origin_z[l])});
    // From anywhere to anywhere within reach.
    const float longest = reach_m + 2 * furthest;
    const std::array<Ends, 3> ends{ends_along(rays.origin_x, rays.direction_x, far, longest),
                                   ends_along(rays.origin_y, rays.direction_y, far, longest),
                                   ends_along(rays.origin_z, rays.direction_z, far, longest)};
    if (ends[0].begin.high < ends[0].begin.low) {
        empty_ = true;
        return;
    }
    const float off = margin * (reach_m + furthest);
    for (int k = 0; k < 3; ++k) {
        const Ends& e = ends[static_cast<std::size_t>(k)];
        box_.low[k] = std::min(e.begin.low, e.end.low) - off;
        box_.high[k] = std::max(e.begin.high, e.end.high) + off;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const Ends &u = ends[(k + 1) % 3], &v = ends[(k + 2) % 3];
        const float way_u = u.end.low + u.end.high - u.begin.low - u.begin.high,
                    way_v = v.end.low + v.end.high - v.begin.low - v.begin.high;
        const float length = std::abs(way_u) + std::abs(way_v);
        Across& axis = across_[k];
        axis.u = length > 0 ? -way_v / length : 0.0F;
        axis.v = length > 0 ? way_u / length : 0.0F;
        const auto covers = [&](const Range& in_u, const Range& in_v) {
            const float middle = 0.5F * (axis.u * (in_u.low + in_u.high) + axis.v * (in_v.low + in_v.high));
            const float half = 0.5F * (std::abs(axis.u) * (in_u.high - in_u.low) +
                                       std::abs(axis.v) * (in_v.high - in_v.low));
            return Range{middle - half, middle + half};
        };
        const Range a = covers(u.begin, v.begin), b = covers(u.end, v.end);
        axis.low = std::min(a.low, b.low) - off;
        axis.high = std::max(a.high, b.high) + off;
    }
}

bool PacketHull::may_meet(const Box& box) const {
    if (empty_) return false;
    for (int k = 0; k < 3; ++k)
        if (box.high[k] < box_.low[k] || box.low[k] > box_.high[k]) return false;
    const Vec3 sum = box.low + box.high, extent = box.high - box.low;
    for (int k = 0; k < 3; ++k) {
        const Across& axis = across_[static_cast<std::size_t>(k)];
        const int u = (k + 1) % 3, v = (k + 2) % 3;
        const float middle = 0.5F * (axis.u * sum[u] + axis.v * sum[v]);
        const float half = 0.5F * (std::abs(axis.u) * extent[u] + std::abs(axis.v) * extent[v]);
        if (middle + half < axis.low || middle - half > axis.high) return false;
    }
    return true;
}

}  // namespace afterglow
