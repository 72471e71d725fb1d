#include "solver/visibility/moving_faces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace afterglow {

namespace {

constexpr std::size_t lanes = 16;
using Floats = std::array<float, lanes>;
using Flags = std::array<std::int32_t, lanes>;

// A body that moves across a ray by less than this in all its frames rests as far as the ray is concerned.
constexpr float rest_m = 1e-7F;

struct Axis {
    float x, y, z;
};

Axis cross(const Axis& a, const Axis& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
float dot(const Axis& a, const Axis& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Axis axis(const Vec3& v) {
    return {v.x, v.y, v.z};
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

/// How a ray sees a moving body: x along the motion as seen along the ray, z along the ray, y across both, so
/// that y never changes; the steps are along x and z.
struct View {
    Axis x, y, z;
    float step_x, step_z;
};

View view_along(const Axis& z, const Axis& step, float rest) {
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

/// A range of values.
struct Span {
    float low, high;
};
Span span_of(const Floats& values) {
    Span out{values[0], values[0]};
    for (const float value : values) out = {std::min(out.low, value), std::max(out.high, value)};
    return out;
}

/// How the lanes see a body. A point q of the body is at (x·q + at_x, y·q + at_y, z·q + at_z) in the first
/// frame; the ray is the line x = y = 0, z > 0. Each lane has axes of its own.
struct alignas(64) OwnViews {
    Floats x0, x1, x2, y0, y1, y2, z0, z1, z2;
    Floats at_x, at_y, at_z, step_x, step_z;
    Floats far;
    float steps = 0;  ///< frames after the first

    /// A corner of a face as each lane sees it.
    struct alignas(64) Corner {
        Floats x, y, z;
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
    static float x_of(const Corner& c, std::size_t l) { return c.x[l]; }
    static float y_of(const Corner& c, std::size_t l) { return c.y[l]; }
    static float z_of(const Corner& c, std::size_t l) { return c.z[l]; }
    [[nodiscard]] float step_along(std::size_t l) const { return step_z[l]; }
    [[nodiscard]] float step_across(std::size_t l) const { return step_x[l]; }
    static bool may_meet(const Corner&, const Corner&, const Corner&) { return true; }
    /// Which faces can be nearest is not asked lane by lane.
    static void leave_out_backs(const TriangleTree&) {}

    /// Whether any lane may meet a box of the body in any frame.
    [[nodiscard]] bool may_meet(const Vec3& centre, const Vec3& half) const {
        Flags met;
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
            met[l] = static_cast<std::int32_t>(std::abs(y) <= half_y) &
                     static_cast<std::int32_t>(x - half_x <= 0) &
                     static_cast<std::int32_t>(x + half_x + steps * step_x[l] >= 0) &
                     static_cast<std::int32_t>(z + half_z + std::max(0.0F, moved_z) > 0) &
                     static_cast<std::int32_t>(z - half_z + std::min(0.0F, moved_z) < far[l]);
        }
        std::int32_t any = 0;
        for (std::size_t l = 0; l < lanes; ++l) any |= met[l];
        return any != 0;
    }
};

OwnViews own_views(const MovingFaces& faces, const RayPacket& rays) {
    const ToBody to_body(faces.first.rotation);
    const Axis step = axis(faces.step_m);
    const Vec3 place = faces.first.translation;
    OwnViews out;
    out.steps = static_cast<float>(faces.frames.count() - 1);
    const float rest = rest_m / std::max(1.0F, out.steps);
    for (std::size_t l = 0; l < lanes; ++l) {
        const View v =
            view_along({rays.direction_x[l], rays.direction_y[l], rays.direction_z[l]}, step, rest);
        const Axis to{place.x - rays.origin_x[l], place.y - rays.origin_y[l], place.z - rays.origin_z[l]};
        out.at_x[l] = dot(v.x, to);
        out.at_y[l] = dot(v.y, to);
        out.at_z[l] = dot(v.z, to);
        out.step_x[l] = v.step_x;
        out.step_z[l] = v.step_z;
        const Axis x = to_body(v.x), y = to_body(v.y), z = to_body(v.z);
        out.x0[l] = x.x, out.x1[l] = x.y, out.x2[l] = x.z;
        out.y0[l] = y.x, out.y1[l] = y.y, out.y2[l] = y.z;
        out.z0[l] = z.x, out.z1[l] = z.y, out.z2[l] = z.z;
        out.far[l] = l < rays.count ? rays.far[l] : 0.0F;
    }
    return out;
}

/// The same for lanes that share one direction, and so all axes: only their places differ. Three times as
/// fast.
struct alignas(64) SharedView {
    Floats at_x, at_y, at_z;
    Axis x, y, z;
    float step_x = 0, step_z = 0, steps = 0, far = 0;
    Span place_x{}, place_y{}, place_z{};  ///< of all lanes
    bool fronts_only = false;              ///< no face that shows its back can be the nearest

    /// A corner, but for each lane's place.
    using Corner = Axis;
    [[nodiscard]] Corner corner(const Vec3& q) const {
        return {dot(x, axis(q)), dot(y, axis(q)), dot(z, axis(q))};
    }
    [[nodiscard]] float x_of(const Corner& c, std::size_t l) const { return c.x + at_x[l]; }
    [[nodiscard]] float y_of(const Corner& c, std::size_t l) const { return c.y + at_y[l]; }
    [[nodiscard]] float z_of(const Corner& c, std::size_t l) const { return c.z + at_z[l]; }
    [[nodiscard]] float step_along(std::size_t) const { return step_z; }
    [[nodiscard]] float step_across(std::size_t) const { return step_x; }

    /// Whether any lane may meet what spans these values at the first frame, before its place is added.
    [[nodiscard]] bool may_meet_spans(const Span& in_x, const Span& in_y, const Span& in_z) const {
        const float moved_z = steps * step_z;
        return in_y.low + place_y.low <= 0 && in_y.high + place_y.high >= 0 && in_x.low + place_x.low <= 0 &&
               in_x.high + place_x.high + steps * step_x >= 0 &&
               in_z.high + place_z.high + std::max(0.0F, moved_z) > 0 &&
               in_z.low + place_z.low + std::min(0.0F, moved_z) < far;
    }
    [[nodiscard]] bool may_meet(const Corner& a, const Corner& b, const Corner& c) const {
        // Seen along the ray, a front's corners run clockwise.
        if (fronts_only && (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) >= 0) return false;
        return may_meet_spans({std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x})},
                              {std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y})},
                              {std::min({a.z, b.z, c.z}), std::max({a.z, b.z, c.z})});
    }
    [[nodiscard]] bool may_meet(const Vec3& centre, const Vec3& half) const {
        return may_meet_spans(along(x, centre, half), along(y, centre, half), along(z, centre, half));
    }
    /// From a closed body that stays ahead of the rays' origins, no face can be seen from behind.
    void leave_out_backs(const TriangleTree& tree) {
        const TriangleTree::Node& root = tree.nodes.front();
        const float nearest = along(z, root.centre, root.half).low + place_z.low;
        fronts_only = tree.closed && nearest + std::min(0.0F, steps * step_z) > 0;
    }

    static Span along(const Axis& on, const Vec3& centre, const Vec3& half) {
        const float middle = dot(on, axis(centre));
        const float reach = std::abs(on.x) * half.x + std::abs(on.y) * half.y + std::abs(on.z) * half.z;
        return {middle - reach, middle + reach};
    }
};

SharedView shared_view(const MovingFaces& faces, const RayPacket& rays) {
    const ToBody to_body(faces.first.rotation);
    const Vec3 place = faces.first.translation;
    SharedView out;
    out.steps = static_cast<float>(faces.frames.count() - 1);
    const View v = view_along({rays.direction_x[0], rays.direction_y[0], rays.direction_z[0]},
                              axis(faces.step_m), rest_m / std::max(1.0F, out.steps));
    for (std::size_t l = 0; l < lanes; ++l) {
        const Axis to{place.x - rays.origin_x[l], place.y - rays.origin_y[l], place.z - rays.origin_z[l]};
        out.at_x[l] = dot(v.x, to);
        out.at_y[l] = dot(v.y, to);
        out.at_z[l] = dot(v.z, to);
    }
    out.place_x = span_of(out.at_x);
    out.place_y = span_of(out.at_y);
    out.place_z = span_of(out.at_z);
    out.x = to_body(v.x);
    out.y = to_body(v.y);
    out.z = to_body(v.z);
    out.step_x = v.step_x;
    out.step_z = v.step_z;
    out.far = *std::max_element(rays.far.begin(), rays.far.begin() + rays.count);
    return out;
}

bool share_a_direction(const RayPacket& rays) {
    bool same = true;
    for (std::size_t l = 1; l < rays.count; ++l)
        same = same && rays.direction_x[l] == rays.direction_x[0] &&
               rays.direction_y[l] == rays.direction_y[0] && rays.direction_z[l] == rays.direction_z[0];
    return same;
}

/// Where the plane y = 0 cuts a triangle: from (low_x, low_z) to (high_x, high_z).
struct alignas(64) Cuts {
    Floats low_x, low_z, high_x, high_z;
    Flags cut;
};

struct Crossing {
    float x, z;
};

/// Where an edge crosses y = 0. Taken from its positive end whichever way round the edge runs, so that the
/// two faces at an edge get the same bits.
Crossing crossing(float ax, float ay, float az, float bx, float by, float bz) {
    const bool a_positive = ay > 0;
    const float px = a_positive ? ax : bx, py = a_positive ? ay : by, pz = a_positive ? az : bz;
    const float nx = a_positive ? bx : ax, ny = a_positive ? by : ay, nz = a_positive ? bz : az;
    const float across = py - ny;
    const float s = across > 0 ? py / across : 0.0F;
    return {px + s * (nx - px), pz + s * (nz - pz)};
}

template <class Views>
Cuts cut(const Views& views, const typename Views::Corner& a, const typename Views::Corner& b,
         const typename Views::Corner& c) {
    Cuts out;
    for (std::size_t l = 0; l < lanes; ++l) {
        const float ax = views.x_of(a, l), ay = views.y_of(a, l), az = views.z_of(a, l);
        const float bx = views.x_of(b, l), by = views.y_of(b, l), bz = views.z_of(b, l);
        const float cx = views.x_of(c, l), cy = views.y_of(c, l), cz = views.z_of(c, l);
        const bool ab = (ay > 0) != (by > 0), bc = (by > 0) != (cy > 0);
        const Crossing on_ab = crossing(ax, ay, az, bx, by, bz);
        const Crossing on_bc = crossing(bx, by, bz, cx, cy, cz);
        const Crossing on_ca = crossing(cx, cy, cz, ax, ay, az);
        // Two of the three edges cross, or none.
        const float ux = ab ? on_ab.x : on_bc.x, uz = ab ? on_ab.z : on_bc.z;
        const float vx = ab && bc ? on_bc.x : on_ca.x, vz = ab && bc ? on_bc.z : on_ca.z;
        const bool ordered = ux <= vx;
        out.low_x[l] = ordered ? ux : vx;
        out.low_z[l] = ordered ? uz : vz;
        out.high_x[l] = ordered ? vx : ux;
        out.high_z[l] = ordered ? vz : uz;
        const float last_x = out.high_x[l] + views.steps * views.step_across(l);
        const bool in_time = (out.low_x[l] <= 0) & (last_x >= 0);
        out.cut[l] = (static_cast<std::int32_t>(ab) | static_cast<std::int32_t>(bc)) &
                     static_cast<std::int32_t>(in_time);
    }
    return out;
}

/// Puts in the frames in which one lane meets the cut, and how far off it is.
template <class Views>
void put_frames(const Views& views, const Cuts& cuts, std::size_t l, const MovingFaces& faces, Index triangle,
                TimeBuffer& buffer) {
    const float low_x = cuts.low_x[l], high_x = cuts.high_x[l], step_x = views.step_across(l);
    float first = 0, last = views.steps;
    if (step_x > 0) {
        // x = -k · step: the far end of the cut comes first. Compared as floats, which cannot overflow.
        first = std::max(first, std::ceil(-high_x / step_x));
        last = std::min(last, std::floor(-low_x / step_x));
    } else if (high_x < 0) {
        return;
    }
    if (!(first <= last)) return;
    const float width = high_x - low_x;
    const float slope = width > 0 ? (cuts.high_z[l] - cuts.low_z[l]) / width : 0.0F;
    const float along = views.step_along(l);
    FaceRun run;
    run.face = faces.first_face + triangle;
    run.first = faces.frames.first + static_cast<int>(first);
    run.last = faces.frames.first + static_cast<int>(last);
    // A cut that is all but a point has no trustworthy slope; its depth still lies between its ends.
    run.low_m = std::min(cuts.low_z[l], cuts.high_z[l]) + first * along;
    run.high_m = std::max(cuts.low_z[l], cuts.high_z[l]) + first * along;
    run.depth_m = cuts.low_z[l] + slope * (-first * step_x - low_x) + first * along;
    run.step_m = -slope * step_x;
    run.along_m = along;
    buffer.put(l, run);
}

template <class Views>
void trace_triangle(const Views& views, const MovingFaces& faces, Index triangle, TimeBuffer& buffer) {
    const auto& v = faces.body.triangles[triangle].vertices;
    const auto a = views.corner(faces.body.positions[v[0]]);
    const auto b = views.corner(faces.body.positions[v[1]]);
    const auto c = views.corner(faces.body.positions[v[2]]);
    if (!views.may_meet(a, b, c)) return;
    const Cuts cuts = cut(views, a, b, c);
    std::uint32_t mask = 0;
    for (std::size_t l = 0; l < lanes; ++l) mask |= static_cast<std::uint32_t>(cuts.cut[l] & 1) << l;
    for (; mask != 0; mask &= mask - 1)
        put_frames(views, cuts, static_cast<std::size_t>(std::countr_zero(mask)), faces, triangle, buffer);
}

template <class Views>
void trace_tree(Views views, const MovingFaces& faces, TimeBuffer& buffer) {
    const TriangleTree& tree = faces.tree;
    views.leave_out_backs(tree);
    // Each step down leaves at most one sibling waiting, and the tree halves: 64 is beyond any count of
    // faces.
    std::array<Index, 64> waiting;
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const TriangleTree::Node& node = tree.nodes[waiting[--count]];
        if (!views.may_meet(node.centre, node.half)) continue;
        if (node.count == 0) {
            waiting[count++] = node.first + 1;
            waiting[count++] = node.first;
            continue;
        }
        for (Index k = node.first; k < node.first + node.count; ++k)
            trace_triangle(views, faces, tree.order[k], buffer);
    }
}

/// The same rays, and copies of the first in the lanes without one: what happens to lie there could be slow
/// to compute with. Those lanes end where they start and meet nothing.
RayPacket filled(RayPacket rays) {
    for (std::size_t l = rays.count; l < lanes; ++l) {
        rays.set(l, rays.ray(0));
        rays.far[l] = 0;
    }
    return rays;
}

void trace_filled(const MovingFaces& faces, const RayPacket& rays, TimeBuffer& buffer) {
    if (share_a_direction(rays))
        trace_tree(shared_view(faces, rays), faces, buffer);
    else
        trace_tree(own_views(faces, rays), faces, buffer);
}

}  // namespace

void trace_moving_faces(const MovingFaces& faces, const RayPacket& rays, TimeBuffer& buffer) {
    if (faces.tree.nodes.empty() || rays.count == 0) return;
    if (rays.count == lanes)
        trace_filled(faces, rays, buffer);
    else
        trace_filled(faces, filled(rays), buffer);
}

}  // namespace afterglow
