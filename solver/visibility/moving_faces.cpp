#include "solver/visibility/moving_faces.h"

#include <array>
#include <bit>
#include <cmath>

#include "solver/visibility/moving_views.h"

namespace afterglow {

namespace {

// A body that moves across a ray by less than this in all its frames rests as far as the ray is concerned.
constexpr float rest_m = 1e-7F;

/// The frames in which each lane meets a cut, and how far off it is: as FaceRun, counted from the body's
/// first frame.
struct alignas(64) Runs {
    LaneFloats first, last, low, high, depth, step, along;
    std::uint32_t met = 0;  ///< bit by lane
};

template <class Views>
Runs runs_of(const Views& views, const LaneCuts& cuts) {
    Runs out;
    std::uint32_t met = 0;
    for (std::uint32_t l = 0; l < lanes; ++l) {
        const float low_x = cuts.low_x[l], high_x = cuts.high_x[l], step_x = views.step_across(l);
        const bool moves = step_x > 0;
        // x = -k · step: the far end of the cut comes first.
        const float step = moves ? step_x : 1.0F;
        const float first = moves ? std::max(0.0F, std::ceil(-high_x / step)) : 0.0F;
        const float last = moves ? std::min(views.steps, std::floor(-low_x / step)) : views.steps;
        const bool covers = moves | ((low_x <= 0) & (high_x >= 0));
        const bool cut = low_x <= high_x;
        met |= static_cast<std::uint32_t>(cut & covers & (first <= last)) << l;
        // A cut that is all but a point has no trustworthy slope; its depth still lies between its ends.
        const float width = high_x - low_x;
        const float slope = width > 0 ? (cuts.high_z[l] - cuts.low_z[l]) / width : 0.0F;
        const float moved = first * views.step_along(l);
        out.first[l] = first;
        out.last[l] = last;
        out.low[l] = std::min(cuts.low_z[l], cuts.high_z[l]) + moved;
        out.high[l] = std::max(cuts.low_z[l], cuts.high_z[l]) + moved;
        out.depth[l] = cuts.low_z[l] + slope * (-first * step_x - low_x) + moved;
        out.step[l] = -slope * step_x;
        out.along[l] = views.step_along(l);
    }
    out.met = met;
    return out;
}

/// A face of N corners.
template <std::size_t N, class Views, class Buffer>
void trace_face(const Views& views, const MovingFaces& faces, Index number, Buffer& buffer) {
    const ConvexFace& face = faces.tree.faces[number];
    if (!views.may_show(face)) return;
    std::array<typename Views::Corner, N> corners;
    for (std::size_t k = 0; k < N; ++k) corners[k] = views.corner(face.corners[k]);
    if (!views.may_meet(corners)) return;
    const Runs runs = runs_of(views, views.cut(corners));
    for (std::uint32_t mask = runs.met; mask != 0; mask &= mask - 1) {
        const auto l = static_cast<std::size_t>(std::countr_zero(mask));
        buffer.put(l, {faces.numbers.first + number, faces.frames.first + static_cast<int>(runs.first[l]),
                       faces.frames.first + static_cast<int>(runs.last[l]), runs.depth[l], runs.step[l],
                       runs.low[l], runs.high[l], runs.along[l], faces.numbers});
    }
}

template <class Views, class Buffer>
void trace_tree(Views views, const MovingFaces& faces, Buffer& buffer) {
    const FaceTree& tree = faces.tree;
    // Each step down leaves at most one sibling waiting, and the tree halves: 64 is beyond any count of
    // faces.
    std::array<Index, 64> waiting;
    std::size_t count = 0;
    if (!views.may_meet(tree.nodes[0].centre, tree.nodes[0].half)) return;
    views.leave_out_backs(tree);
    waiting[count++] = 0;
    while (count > 0) {
        const FaceTree::Node& node = tree.nodes[waiting[--count]];
        if (!views.may_meet(node.centre, node.half)) continue;
        if (node.count == 0) {
            waiting[count++] = node.first + 1;
            waiting[count++] = node.first;
            continue;
        }
        for (Index k = node.first; k < node.first + node.count; ++k) {
            if (tree.faces[k].count == 4)
                trace_face<4>(views, faces, k, buffer);
            else
                trace_face<3>(views, faces, k, buffer);
        }
    }
}

bool share_a_direction(const RayPacket& rays) {
    bool same = true;
    for (std::size_t l = 1; l < rays.count; ++l)
        same = same && rays.direction_x[l] == rays.direction_x[0] &&
               rays.direction_y[l] == rays.direction_y[0] && rays.direction_z[l] == rays.direction_z[0];
    return same;
}

/// The same rays, and copies of the first in the lanes without one: what happens to lie there could be slow
/// to compute with. Those lanes end where they start and meet nothing.
void fill(const RayPacket& rays, RayPacket& filled) {
    filled = rays;
    for (std::size_t l = rays.count; l < lanes; ++l) {
        filled.set(l, rays.ray(0));
        filled.far[l] = 0;
    }
}

template <class Buffer>
void trace_filled(const MovingFaces& faces, const RayPacket& rays, Buffer& buffer) {
    const auto steps = static_cast<float>(faces.frames.count() - 1);
    const float rest = rest_m / std::max(1.0F, steps);
    if (share_a_direction(rays))
        trace_tree(SharedView(faces.first, faces.step_m, steps, rest, rays), faces, buffer);
    else
        trace_tree(OwnViews(faces.first, faces.step_m, steps, rest, rays), faces, buffer);
}

template <class Buffer>
void trace(const MovingFaces& faces, const RayPacket& rays, Buffer& buffer) {
    if (faces.tree.nodes.empty() || rays.count == 0) return;
    if (rays.count == lanes) {
        trace_filled(faces, rays, buffer);
        return;
    }
    RayPacket filled;
    fill(rays, filled);
    trace_filled(faces, filled, buffer);
}

}  // namespace

void trace_moving_faces(const MovingFaces& faces, const RayPacket& rays, TimeBuffer& buffer) {
    trace(faces, rays, buffer);
}

void trace_moving_faces(const MovingFaces& faces, const RayPacket& rays, HiddenFrames& hidden) {
    trace(faces, rays, hidden);
}

}  // namespace afterglow
