#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "solver/visibility/face_tree.h"
#include "solver/visibility/ray_caster.h"

// How sixteen fixed rays see a body that moves steadily: in each ray's own axes, x along the motion as seen
// along the ray, z along the ray, y across both, so that y never changes. Parts of moving_faces.cpp, which
// is compiled so that their loops become vector code.

namespace afterglow {

inline constexpr std::size_t lanes = 16;
using LaneFloats = std::array<float, lanes>;

struct Axis {
    float x, y, z;
};
inline Axis axis(const Vec3& v) {
    return {v.x, v.y, v.z};
}
inline Axis cross(const Axis& a, const Axis& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float dot(const Axis& a, const Axis& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The axes of one ray, and the body's steps along x and z.
struct LaneAxes {
    Axis x, y, z;
    float step_x, step_z;
};

/// `rest`: a body that moves across the ray by less in a step rests as far as the ray is concerned.
inline LaneAxes axes_along(const Axis& z, const Axis& step, float rest) {
    const float along = dot(step, z);
    const Axis across{step.x - along * z.x, step.y - along * z.y, step.z - along * z.z};
    const float length = std::sqrt(dot(across, across));
    const bool moves = length > rest;
    // Any axis across the ray will do for a body that does not move across it (Duff et al. 2017).
    const float sign = std::copysign(1.0F, z.z);
    const float a = -1.0F / (sign + z.z);
    const Axis any{1.0F + sign * z.x * z.x * a, sign * z.x * z.y * a, -sign * z.x};
    const float scale = moves ? 1 / length : 0.0F;
    const Axis x{moves ? scale * across.x : any.x, moves ? scale * across.y : any.y,
                 moves ? scale * across.z : any.z};
    return {x, cross(z, x), z, moves ? length : 0.0F, along};
}

/// The columns of a rotation: what turns world axes into the body's.
struct ToBody {
    Vec3 x, y, z;
    explicit ToBody(const Quat& rotation)
        : x(rotation * Vec3(1, 0, 0)), y(rotation * Vec3(0, 1, 0)), z(rotation * Vec3(0, 0, 1)) {}
    [[nodiscard]] Axis operator()(const Axis& a) const {
        return {a.x * x.x + a.y * x.y + a.z * x.z, a.x * y.x + a.y * y.y + a.z * y.z,
                a.x * z.x + a.y * z.y + a.z * z.z};
    }
};

/// Where the plane y = 0 cuts a convex face: from (low_x, low_z) to (high_x, high_z); from +∞ to −∞ where it
/// does not.
struct LaneCut {
    float low_x = std::numeric_limits<float>::infinity(), low_z = 0;
    float high_x = -std::numeric_limits<float>::infinity(), high_z = 0;

    void add(bool crosses, float x, float z) {
        const bool lower = crosses & (x < low_x), higher = crosses & (x > high_x);
        low_x = lower ? x : low_x;
        low_z = lower ? z : low_z;
        high_x = higher ? x : high_x;
        high_z = higher ? z : high_z;
    }
};
struct alignas(64) LaneCuts {
    LaneFloats low_x, low_z, high_x, high_z;
    void set(std::size_t l, const LaneCut& cut) {
        low_x[l] = cut.low_x;
        low_z[l] = cut.low_z;
        high_x[l] = cut.high_x;
        high_z[l] = cut.high_z;
    }
};

/// Calls `each(k)` for k in [0, N), written out: a loop inside the loop over lanes would keep that one from
/// becoming vector code.
template <std::size_t N, class Each>
void for_each_of(const Each& each) {
    [&]<std::size_t... K>(std::index_sequence<K...>) {
        (each(K), ...);
    }
    (std::make_index_sequence<N>{});
}

/// Lanes that each have a direction. A point q of the body is at (x·q + at_x, y·q + at_y, z·q + at_z) in the
/// first frame; the ray is the line x = y = 0, z > 0.
struct alignas(64) OwnViews {
    LaneFloats x0, x1, x2, y0, y1, y2, z0, z1, z2;
    LaneFloats at_x, at_y, at_z, step_x, step_z;
    LaneFloats far;
    float steps = 0;           ///< frames after the first
    bool fronts_only = false;  ///< no face that shows its back can be the nearest

    OwnViews(const Pose& first, const Vec3& step_m, float steps_, float rest, const RayPacket& rays)
        : steps(steps_) {
        const ToBody to_body(first.rotation);
        const Axis step = axis(step_m);
        const Vec3 place = first.translation;
        for (std::size_t l = 0; l < lanes; ++l) {
            const LaneAxes v =
                axes_along({rays.direction_x[l], rays.direction_y[l], rays.direction_z[l]}, step, rest);
            const Axis to{place.x - rays.origin_x[l], place.y - rays.origin_y[l], place.z - rays.origin_z[l]};
            at_x[l] = dot(v.x, to);
            at_y[l] = dot(v.y, to);
            at_z[l] = dot(v.z, to);
            step_x[l] = v.step_x;
            step_z[l] = v.step_z;
            const Axis x = to_body(v.x), y = to_body(v.y), z = to_body(v.z);
            x0[l] = x.x, x1[l] = x.y, x2[l] = x.z;
            y0[l] = y.x, y1[l] = y.y, y2[l] = y.z;
            z0[l] = z.x, z1[l] = z.y, z2[l] = z.z;
            far[l] = rays.far[l];
        }
    }

    /// A corner of a face as each lane sees it.
    struct alignas(64) Corner {
        LaneFloats x, y, z;
    };
    [[nodiscard]] Corner corner(const Vec3& q) const {
        Corner out;
        for (std::size_t l = 0; l < lanes; ++l) {
            out.x[l] = x0[l] * q.x + x1[l] * q.y + x2[l] * q.z + at_x[l];
            out.y[l] = y0[l] * q.x + y1[l] * q.y + y2[l] * q.z + at_y[l];
            out.z[l] = z0[l] * q.x + z1[l] * q.y + z2[l] * q.z + at_z[l];
        }
        return out;
    }
    [[nodiscard]] float step_along(std::size_t l) const { return step_z[l]; }
    [[nodiscard]] float step_across(std::size_t l) const { return step_x[l]; }

    /// Whether any lane may see a face's front, where only those count.
    [[nodiscard]] bool may_show(const ConvexFace& face) const {
        if (!fronts_only) return true;
        const Vec3 n = face.normal;
        std::int32_t any = 0;
        for (std::size_t l = 0; l < lanes; ++l)
            any |= static_cast<std::int32_t>(z0[l] * n.x + z1[l] * n.y + z2[l] * n.z < 0);
        return any != 0;
    }
    template <std::size_t N>
    static bool may_meet(const std::array<Corner, N>&) {
        return true;
    }

    /// Whether any lane may meet a box of the body in any frame.
    [[nodiscard]] bool may_meet(const Vec3& centre, const Vec3& half) const {
        std::int32_t any = 0;
        for (std::size_t l = 0; l < lanes; ++l) {
            const float y = y0[l] * centre.x + y1[l] * centre.y + y2[l] * centre.z + at_y[l];
            const float half_y =
                std::abs(y0[l]) * half.x + std::abs(y1[l]) * half.y + std::abs(y2[l]) * half.z;
            const float x = x0[l] * centre.x + x1[l] * centre.y + x2[l] * centre.z + at_x[l];
            const float half_x =
                std::abs(x0[l]) * half.x + std::abs(x1[l]) * half.y + std::abs(x2[l]) * half.z;
            const float z = z0[l] * centre.x + z1[l] * centre.y + z2[l] * centre.z + at_z[l];
            const float half_z =
                std::abs(z0[l]) * half.x + std::abs(z1[l]) * half.y + std::abs(z2[l]) * half.z;
            const float moved_z = steps * step_z[l];
            any |= static_cast<std::int32_t>(std::abs(y) <= half_y) &
                   static_cast<std::int32_t>(x - half_x <= 0) &
                   static_cast<std::int32_t>(x + half_x + steps * step_x[l] >= 0) &
                   static_cast<std::int32_t>(z + half_z + std::max(0.0F, moved_z) > 0) &
                   static_cast<std::int32_t>(z - half_z + std::min(0.0F, moved_z) < far[l]);
        }
        return any != 0;
    }

    /// From a closed body that stays ahead of the rays' origins, no face can be seen from behind.
    void leave_out_backs(const FaceTree& tree) {
        const Vec3 centre = tree.nodes.front().centre, half = tree.nodes.front().half;
        float nearest = std::numeric_limits<float>::infinity();
        for (std::size_t l = 0; l < lanes; ++l) {
            const float z = z0[l] * centre.x + z1[l] * centre.y + z2[l] * centre.z + at_z[l];
            const float half_z =
                std::abs(z0[l]) * half.x + std::abs(z1[l]) * half.y + std::abs(z2[l]) * half.z;
            nearest = std::min(nearest, z - half_z + std::min(0.0F, steps * step_z[l]));
        }
        fronts_only = tree.closed && nearest > 0;
    }

    /// Where y = 0 cuts a face of N corners. Each edge is taken from its positive end whichever way round it
    /// runs, so that the two faces at an edge get the same bits.
    template <std::size_t N>
    [[nodiscard]] LaneCuts cut(const std::array<Corner, N>& corners) const {
        LaneCuts out;
        for (std::size_t l = 0; l < lanes; ++l) {
            LaneCut cut;
            for_each_of<N>([&](std::size_t k) {
                const Corner &a = corners[k], &b = corners[(k + 1) % N];
                const bool a_positive = a.y[l] > 0, b_positive = b.y[l] > 0;
                const float px = a_positive ? a.x[l] : b.x[l], py = a_positive ? a.y[l] : b.y[l],
                            pz = a_positive ? a.z[l] : b.z[l];
                const float nx = a_positive ? b.x[l] : a.x[l], ny = a_positive ? b.y[l] : a.y[l],
                            nz = a_positive ? b.z[l] : a.z[l];
                const float across = py - ny;
                const float s = across > 0 ? py / across : 0.0F;
                cut.add(a_positive != b_positive, px + s * (nx - px), pz + s * (nz - pz));
            });
            out.set(l, cut);
        }
        return out;
    }
};

/// The same for lanes that share one direction, and so all axes: only their places differ.
struct alignas(64) SharedView {
    LaneFloats at_x, at_y, at_z;
    Axis x, y, z;
    float step_x = 0, step_z = 0, steps = 0, far = 0;
    bool fronts_only = false;

    /// A range of values.
    struct Span {
        float low, high;
    };
    Span place_x{}, place_y{}, place_z{};  ///< of all lanes

    SharedView(const Pose& first, const Vec3& step_m, float steps_, float rest, const RayPacket& rays)
        : steps(steps_) {
        const ToBody to_body(first.rotation);
        const Vec3 place = first.translation;
        const LaneAxes v =
            axes_along({rays.direction_x[0], rays.direction_y[0], rays.direction_z[0]}, axis(step_m), rest);
        for (std::size_t l = 0; l < lanes; ++l) {
            const Axis to{place.x - rays.origin_x[l], place.y - rays.origin_y[l], place.z - rays.origin_z[l]};
            at_x[l] = dot(v.x, to);
            at_y[l] = dot(v.y, to);
            at_z[l] = dot(v.z, to);
        }
        place_x = span_of(at_x);
        place_y = span_of(at_y);
        place_z = span_of(at_z);
        x = to_body(v.x);
        y = to_body(v.y);
        z = to_body(v.z);
        step_x = v.step_x;
        step_z = v.step_z;
        far = *std::max_element(rays.far.begin(), rays.far.end());
    }
    static Span span_of(const LaneFloats& values) {
        Span out{values[0], values[0]};
        for (const float value : values) out = {std::min(out.low, value), std::max(out.high, value)};
        return out;
    }

    /// A corner, but for each lane's place.
    using Corner = Axis;
    [[nodiscard]] Corner corner(const Vec3& q) const {
        return {dot(x, axis(q)), dot(y, axis(q)), dot(z, axis(q))};
    }
    [[nodiscard]] float step_along(std::size_t) const { return step_z; }
    [[nodiscard]] float step_across(std::size_t) const { return step_x; }

    [[nodiscard]] bool may_show(const ConvexFace& face) const {
        return !fronts_only || dot(z, axis(face.normal)) < 0;
    }

    /// Whether any lane may meet what spans these values at the first frame, before its place is added.
    [[nodiscard]] bool may_meet_spans(const Span& in_x, const Span& in_y, const Span& in_z) const {
        const float moved_z = steps * step_z;
        return in_y.low + place_y.low <= 0 && in_y.high + place_y.high >= 0 && in_x.low + place_x.low <= 0 &&
               in_x.high + place_x.high + steps * step_x >= 0 &&
               in_z.high + place_z.high + std::max(0.0F, moved_z) > 0 &&
               in_z.low + place_z.low + std::min(0.0F, moved_z) < far;
    }
    template <std::size_t N>
    [[nodiscard]] bool may_meet(const std::array<Corner, N>& corners) const {
        Span in_x{corners[0].x, corners[0].x}, in_y{corners[0].y, corners[0].y},
            in_z{corners[0].z, corners[0].z};
        for (const Corner& c : corners) {
            in_x = {std::min(in_x.low, c.x), std::max(in_x.high, c.x)};
            in_y = {std::min(in_y.low, c.y), std::max(in_y.high, c.y)};
            in_z = {std::min(in_z.low, c.z), std::max(in_z.high, c.z)};
        }
        return may_meet_spans(in_x, in_y, in_z);
    }
    [[nodiscard]] bool may_meet(const Vec3& centre, const Vec3& half) const {
        return may_meet_spans(along(x, centre, half), along(y, centre, half), along(z, centre, half));
    }
    void leave_out_backs(const FaceTree& tree) {
        const FaceTree::Node& root = tree.nodes.front();
        const float nearest = along(z, root.centre, root.half).low + place_z.low;
        fronts_only = tree.closed && nearest + std::min(0.0F, steps * step_z) > 0;
    }

    /// Each edge from its end of higher y, which is the positive one in every lane in which it crosses 0.
    template <std::size_t N>
    [[nodiscard]] LaneCuts cut(const std::array<Corner, N>& corners) const {
        struct Edge {
            Corner p;
            float ny, per_y, across_x, across_z;
        };
        std::array<Edge, N> edges;
        for (std::size_t k = 0; k < N; ++k) {
            const Corner &a = corners[k], &b = corners[(k + 1) % N];
            const Corner &p = a.y > b.y ? a : b, &n = a.y > b.y ? b : a;
            edges[k] = {p, n.y, p.y > n.y ? 1 / (p.y - n.y) : 0.0F, n.x - p.x, n.z - p.z};
        }
        LaneCuts out;
        for (std::size_t l = 0; l < lanes; ++l) {
            LaneCut cut;
            for_each_of<N>([&](std::size_t k) {
                const Edge& e = edges[k];
                const float py = e.p.y + at_y[l], ny = e.ny + at_y[l];
                // Lanes differ by rounding from what per_y was taken from: no further than the edge's end.
                const float s = std::min(py * e.per_y, 1.0F);
                cut.add((py > 0) != (ny > 0), (e.p.x + s * e.across_x) + at_x[l],
                        (e.p.z + s * e.across_z) + at_z[l]);
            });
            out.set(l, cut);
        }
        return out;
    }

    static Span along(const Axis& on, const Vec3& centre, const Vec3& half) {
        const float middle = dot(on, axis(centre));
        const float reach = std::abs(on.x) * half.x + std::abs(on.y) * half.y + std::abs(on.z) * half.z;
        return {middle - reach, middle + reach};
    }
};

}  // namespace afterglow
