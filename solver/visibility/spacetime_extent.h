#pragma once

#include <span>
#include <vector>

#include "solver/scene/world.h"
#include "solver/visibility/motion.h"

namespace afterglow {

/// Times from `begin_s` up to, not including, `end_s`.
struct TimeSpan {
    double begin_s = 0, end_s = 0;
    [[nodiscard]] bool contains(double time_s) const { return begin_s <= time_s && time_s < end_s; }
    bool operator==(const TimeSpan&) const = default;
};

/// All times in 2^k slices, and their unions in a binary tree: node 1 is all times, node n is the union of
/// nodes 2n and 2n+1, and the last 2^k nodes are the slices. The first begins at −∞, the last ends at +∞.
struct TimeTree {
    std::vector<double> borders_s;  ///< between the slices: 2^k − 1 of them, rising

    [[nodiscard]] std::size_t slices() const { return borders_s.size() + 1; }
    [[nodiscard]] TimeSpan slice(std::size_t index) const;
    /// The slice that holds a time.
    [[nodiscard]] std::size_t slice_at(double time_s) const;
};

/// Slices no longer than asked from the first to the last key of all paths, at most 2^`most_levels` of them.
/// Thread-safety: pure.
TimeTree make_time_tree(std::span<const Path> paths, double slice_s, int most_levels = 8);

/// Where something is during each node of a time tree: world boxes, node 0 unused. One box stands for all
/// nodes where it never moves.
struct SpacetimeExtent {
    std::vector<Box> box;

    [[nodiscard]] const Box& at(std::size_t node) const { return box.size() == 1 ? box[0] : box[node]; }
};

/// The box around `local` of a body that stands at a pose, grown by `slack_m` on every side; empty if `local`
/// is. Thread-safety: pure.
Box placed_box(const Box& local, const Pose& pose, float slack_m);

/// The boxes swept by whatever lies in `local` of a body that moves on a path, grown by `slack_m` on every
/// side. Conservative where the body turns: corners bulge out of the chord between two times by no more than
/// the arc's sagitta. An empty `local` sweeps empty boxes. Thread-safety: pure.
SpacetimeExtent swept_extent(const Box& local, const Path& path, const TimeTree& times, float slack_m);

/// That of something that never moves.
SpacetimeExtent resting_extent(const Box& box);

/// Whether a line from somewhere in `from` to somewhere in `target` may pass through `blocker`: whether the
/// blocker meets the convex hull of the two other boxes. Exact for boxes. Empty boxes block nothing and are
/// not blocked. The hull's planes are those of Haines and Wallace's shafts (1991), each parallel to an axis.
/// Thread-safety: pure.
bool may_hide(const Box& blocker, const Box& target, const Box& from);

/// When the blocker may hide the target from the viewpoints, slices in one where they touch: in order of
/// time, apart from each other. Thread-safety: pure.
std::vector<TimeSpan> hiding_spans(const SpacetimeExtent& blocker, const SpacetimeExtent& target,
                                   const SpacetimeExtent& from, const TimeTree& times);

}  // namespace afterglow
