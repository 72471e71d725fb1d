#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/visibility/relative_motion.h"

namespace afterglow {

/// Who looks: all points that lie within both a ball and a box around one place. A radius of 0 is a point;
/// the ball and the box around a block of patches hold the origins of all their lines.
struct Viewpoint {
    Vec3d offset_m{0};  ///< from the viewer's origin, world axes; the place itself for a viewer without path
    double radius_m = 0;        ///< 0 or more
    Vec3d half_extent_m{1e30};  ///< of the box, world axes; used where the body does not turn
};

/// On which side of a node's plane a viewpoint is.
enum class PlaneSide : std::uint8_t {
    front,
    back,
    across,  ///< the viewpoint reaches across: the faces below the node have no common order for all its
             ///< points
};

/// One face in the order of a viewpoint.
struct OrderedFace {
    Index face = 0;          ///< of the tree
    bool begins_run = true;  ///< false: may be nearer or farther than the one before (one plane, or `across`)
};

/// A temporal BSP tree: at each node of a body's tree the side a viewpoint is on and the time at which that
/// may change, at the root of each subtree the earliest of these, and the faces' order that follows from the
/// sides, kept for as long as no side changes.
struct TemporalBsp {
    struct Node {
        PlaneSide side = PlaneSide::front;
        double change_s = 0;    ///< the side holds until then
        double earliest_s = 0;  ///< least change_s of the subtree
    };
    std::vector<Node> nodes;         ///< by node of the tree; below `across` they mean nothing
    std::vector<OrderedFace> order;  ///< front to back
    double since_s = 0;              ///< when nodes were last visited: it says nothing of times before

    /// When anything may change; +∞: never again.
    [[nodiscard]] double next_change_s() const;
};

/// What an update had to do.
struct TreeWork {
    std::uint64_t nodes_visited = 0;
    std::uint64_t sides_changed = 0;
};

/// The tree of a viewpoint at a time. Where the body does not turn, change_s is the root of the (linear)
/// distance to the plane; where it turns, a lower bound: what is left of that distance over the greatest
/// relative speed. At the latest it is the next knot. Thread-safety: pure.
TemporalBsp make_temporal_bsp(const BspTree& tree, std::span<const SteadyView> views,
                              const Viewpoint& viewpoint, double time_s);

/// Brings the tree to another time: only subtrees whose earliest change has come are visited, and only below
/// changed sides is the order written anew. Times before `since_s` begin from scratch. The same order as
/// make_temporal_bsp at that time. Source: Tost and Pueyo 1993, section 3; Tost 1991.
TreeWork update(TemporalBsp& temporal, const BspTree& tree, std::span<const SteadyView> views,
                const Viewpoint& viewpoint, double time_s);

}  // namespace afterglow
