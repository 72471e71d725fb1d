#pragma once

#include <span>
#include <vector>

#include "solver/visibility/bsp_tree.h"
#include "solver/visibility/motion.h"

namespace afterglow {

/// The time [begin_s, end_s) in which a body and whoever looks at it both move steadily: between two
/// neighbouring knots of either.
struct SteadyView {
    double begin_s = 0, end_s = 0;
    MotionSegment body, viewer;

    /// Where the viewer's origin, moved by `offset_m` in world axes, stands in the body's frame at a time of
    /// this view. The viewer's own turning does not matter to where it stands.
    [[nodiscard]] Vec3d place(const Vec3d& offset_m, double time_s) const;
    /// How fast that place moves, metres a second; only where the body does not turn (it is constant then).
    [[nodiscard]] Vec3d velocity() const;
    /// A direction of the body's frame in world axes; only where the body does not turn.
    [[nodiscard]] Vec3d in_world(const Vec3d& direction) const;
    /// No less than the speed of that place in the body's frame from `from_s` to the end of this view.
    [[nodiscard]] double greatest_speed(const Vec3d& offset_m, double from_s) const;
};

/// The steady views in order of time, without gaps, from −∞ to +∞. Thread-safety: pure.
std::vector<SteadyView> steady_views(const Path& body, const Path& viewer);

/// The one that holds a time.
const SteadyView& view_at(std::span<const SteadyView> views, double time_s);

}  // namespace afterglow
