#include "solver/visibility/moving_faces.h"

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

/// Each lane's view of a body: x along the body's motion as seen along the ray, z along the ray, y across
/// both, so that y never changes. A point q of the body is at (x·q + at_x, y·q + at_y, z·q + at_z) in the
/// first frame, and steps by step_x, 0, step_z; the ray is the line x = y = 0, z > 0.
struct alignas(64) LaneFrames {
    Floats x0, x1, x2, y0, y1, y2, z0, z1, z2;
    Floats at_x, at_y, at_z, step_x, step_z;
    Floats far;
    float steps = 0;  ///< frames after the first
};

struct Axis {
    float x, y, z;
};

Axis cross(const Axis& a, const Axis& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
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

void set_up(const MovingFaces& faces, const RayPacket& rays, LaneFrames& out) {
    const ToBody to_body(faces.first.rotation);
    const Vec3 place = faces.first.translation;
    const Vec3 step = faces.step_m;
    out.steps = static_cast<float>(faces.frames.count() - 1);
    const float rest = rest_m / std::max(1.0F, out.steps);
    for (std::size_t l = 0; l < lanes; ++l) {
        const Axis z{rays.direction_x[l], rays.direction_y[l], rays.direction_z[l]};
        const float along = step.x * z.x + step.y * z.y + step.z * z.z;
        const Axis across{step.x - along * z.x, step.y - along * z.y, step.z - along * z.z};
        const float length = std::sqrt(across.x * across.x + across.y * across.y + across.z * across.z);
        const bool moves = length > rest;
        // Any axis across the ray will do for a body that does not move across it (Duff et al. 2017).
        const float sign = std::copysign(1.0F, z.z);
        const float a = -1.0F / (sign + z.z);
        const Axis any{1.0F + sign * z.x * z.x * a, sign * z.x * z.y * a, -sign * z.x};
        const float scale = moves ? 1 / length : 0.0F;
        const Axis x{moves ? scale * across.x : any.x, moves ? scale * across.y : any.y,
                     moves ? scale * across.z : any.z};
        const Axis y = cross(z, x);
        const Axis to{place.x - rays.origin_x[l], place.y - rays.origin_y[l], place.z - rays.origin_z[l]};
        out.at_x[l] = x.x * to.x + x.y * to.y + x.z * to.z;
        out.at_y[l] = y.x * to.x + y.y * to.y + y.z * to.z;
        out.at_z[l] = z.x * to.x + z.y * to.y + z.z * to.z;
        out.step_x[l] = moves ? length : 0.0F;
        out.step_z[l] = along;
        const Axis bx = to_body(x), by = to_body(y), bz = to_body(z);
        out.x0[l] = bx.x, out.x1[l] = bx.y, out.x2[l] = bx.z;
        out.y0[l] = by.x, out.y1[l] = by.y, out.y2[l] = by.z;
        out.z0[l] = bz.x, out.z1[l] = bz.y, out.z2[l] = bz.z;
        out.far[l] = l < rays.count ? rays.far[l] : 0.0F;
    }
}

/// Whether any lane may meet a box of the body in any frame.
bool meets(const LaneFrames& f, const Vec3& centre, const Vec3& half) {
    Flags met;
    for (std::size_t l = 0; l < lanes; ++l) {
        const float y = f.y0[l] * centre.x + f.y1[l] * centre.y + f.y2[l] * centre.z + f.at_y[l];
        const float half_y =
            std::abs(f.y0[l]) * half.x + std::abs(f.y1[l]) * half.y + std::abs(f.y2[l]) * half.z;
        const float x = f.x0[l] * centre.x + f.x1[l] * centre.y + f.x2[l] * centre.z + f.at_x[l];
        const float half_x =
            std::abs(f.x0[l]) * half.x + std::abs(f.x1[l]) * half.y + std::abs(f.x2[l]) * half.z;
        const float z = f.z0[l] * centre.x + f.z1[l] * centre.y + f.z2[l] * centre.z + f.at_z[l];
        const float half_z =
            std::abs(f.z0[l]) * half.x + std::abs(f.z1[l]) * half.y + std::abs(f.z2[l]) * half.z;
        const float moved_z = f.steps * f.step_z[l];
        met[l] = static_cast<std::int32_t>(std::abs(y) <= half_y) &
                 static_cast<std::int32_t>(x - half_x <= 0) &
                 static_cast<std::int32_t>(x + half_x + f.steps * f.step_x[l] >= 0) &
                 static_cast<std::int32_t>(z + half_z + std::max(0.0F, moved_z) > 0) &
                 static_cast<std::int32_t>(z - half_z + std::min(0.0F, moved_z) < f.far[l]);
    }
    std::int32_t any = 0;
    for (std::size_t l = 0; l < lanes; ++l) any |= met[l];
    return any != 0;
}

/// A triangle's corner as the lanes see it.
struct alignas(64) Corner {
    Floats x, y, z;
};

void place(const LaneFrames& f, const Vec3& q, Corner& out) {
    for (std::size_t l = 0; l < lanes; ++l) {
        out.x[l] = f.x0[l] * q.x + f.x1[l] * q.y + f.x2[l] * q.z + f.at_x[l];
        out.y[l] = f.y0[l] * q.x + f.y1[l] * q.y + f.y2[l] * q.z + f.at_y[l];
        out.z[l] = f.z0[l] * q.x + f.z1[l] * q.y + f.z2[l] * q.z + f.at_z[l];
    }
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

void cut(const Corner& a, const Corner& b, const Corner& c, Cuts& out) {
    for (std::size_t l = 0; l < lanes; ++l) {
        const bool positive_a = a.y[l] > 0, positive_b = b.y[l] > 0, positive_c = c.y[l] > 0;
        const bool ab = positive_a != positive_b, bc = positive_b != positive_c;
        const Crossing on_ab = crossing(a.x[l], a.y[l], a.z[l], b.x[l], b.y[l], b.z[l]);
        const Crossing on_bc = crossing(b.x[l], b.y[l], b.z[l], c.x[l], c.y[l], c.z[l]);
        const Crossing on_ca = crossing(c.x[l], c.y[l], c.z[l], a.x[l], a.y[l], a.z[l]);
        // Two of the three edges cross, or none.
        const float ux = ab ? on_ab.x : on_bc.x, uz = ab ? on_ab.z : on_bc.z;
        const float vx = ab && bc ? on_bc.x : on_ca.x, vz = ab && bc ? on_bc.z : on_ca.z;
        const bool ordered = ux <= vx;
        out.low_x[l] = ordered ? ux : vx;
        out.low_z[l] = ordered ? uz : vz;
        out.high_x[l] = ordered ? vx : ux;
        out.high_z[l] = ordered ? vz : uz;
        out.cut[l] = static_cast<std::int32_t>(ab) | static_cast<std::int32_t>(bc);
    }
}

/// Which lanes meet the cut in some frame: bit by bit.
std::uint32_t meeting(const LaneFrames& f, const Cuts& cuts) {
    Flags met;
    for (std::size_t l = 0; l < lanes; ++l)
        met[l] = cuts.cut[l] & static_cast<std::int32_t>(cuts.low_x[l] <= 0) &
                 static_cast<std::int32_t>(cuts.high_x[l] + f.steps * f.step_x[l] >= 0);
    std::uint32_t mask = 0;
    for (std::size_t l = 0; l < lanes; ++l) mask |= static_cast<std::uint32_t>(met[l]) << l;
    return mask;
}

/// The frames in which one lane meets the cut, and how far off.
void put_frames(const LaneFrames& f, const Cuts& cuts, std::size_t l, const MovingFaces& faces,
                Index triangle, TimeBuffer& buffer) {
    const float low_x = cuts.low_x[l], high_x = cuts.high_x[l];
    float first = 0, last = f.steps;
    if (f.step_x[l] > 0) {
        // x = -k · step: the far end of the cut comes first. Compared as floats, which cannot overflow.
        first = std::max(first, std::ceil(-high_x / f.step_x[l]));
        last = std::min(last, std::floor(-low_x / f.step_x[l]));
    } else if (high_x < 0) {
        return;
    }
    const float width = high_x - low_x;
    const float slope = width > 0 ? (cuts.high_z[l] - cuts.low_z[l]) / width : 0.0F;
    const float low = std::min(cuts.low_z[l], cuts.high_z[l]), high = std::max(cuts.low_z[l], cuts.high_z[l]);
    for (float k = first; k <= last; ++k) {
        // A cut that is all but a point has no trustworthy slope; its depth still lies between its ends.
        const float on_face = std::clamp(cuts.low_z[l] + slope * (-k * f.step_x[l] - low_x), low, high);
        buffer.put(l, faces.frames.first + static_cast<int>(k), on_face + k * f.step_z[l],
                   {faces.body_index, triangle});
    }
}

void trace_triangle(const LaneFrames& f, const MovingFaces& faces, Index triangle, TimeBuffer& buffer) {
    const auto& v = faces.body.triangles[triangle].vertices;
    Corner a, b, c;
    place(f, faces.body.positions[v[0]], a);
    place(f, faces.body.positions[v[1]], b);
    place(f, faces.body.positions[v[2]], c);
    Cuts cuts;
    cut(a, b, c, cuts);
    for (std::uint32_t mask = meeting(f, cuts); mask != 0; mask &= mask - 1)
        put_frames(f, cuts, static_cast<std::size_t>(std::countr_zero(mask)), faces, triangle, buffer);
}

/// The same rays, and copies of the first in the lanes without one: what happens to lie there could be slow
/// to compute with.
RayPacket filled(RayPacket rays) {
    for (std::size_t l = rays.count; l < lanes; ++l) rays.set(l, rays.ray(0));
    return rays;
}

}  // namespace

void trace_moving_faces(const MovingFaces& faces, const RayPacket& rays, TimeBuffer& buffer) {
    const TriangleTree& tree = faces.tree;
    if (tree.nodes.empty() || rays.count == 0) return;
    LaneFrames f;
    if (rays.count == lanes)
        set_up(faces, rays, f);
    else
        set_up(faces, filled(rays), f);
    // Each step down leaves at most one sibling waiting, and the tree halves: 64 is beyond any count of
    // faces.
    std::array<Index, 64> waiting;
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const TriangleTree::Node& node = tree.nodes[waiting[--count]];
        if (!meets(f, node.centre, node.half)) continue;
        if (node.count == 0) {
            waiting[count++] = node.first + 1;
            waiting[count++] = node.first;
            continue;
        }
        for (Index k = node.first; k < node.first + node.count; ++k)
            trace_triangle(f, faces, tree.order[k], buffer);
    }
}

}  // namespace afterglow
