#pragma once

#include <array>

#include "solver/base/math.h"
#include "solver/visibility/ray_caster.h"

namespace afterglow {

/// The convex hull of two boxes: of where a packet's rays begin and of where they end. Asks whether any of
/// them may come into a box, without looking at each.
class PacketHull {
  public:
    /// Rays count as far as their `far` says, and no further than `reach_m` from the world's origin: no box
    /// asked for lies beyond. Lanes of no length count for nothing.
    PacketHull(const RayPacket& rays, float reach_m);

    /// False only where no ray of the packet meets the box. Separating axes: the three of the world, and in
    /// each of its planes the one across the way from the middle of the first box to that of the second.
    [[nodiscard]] bool may_meet(const Box& box) const;

  private:
    struct Across {
        float u = 0, v = 0;       ///< the axis, in the plane's coordinates
        float low = 0, high = 0;  ///< what the hull covers of it
    };
    Box box_;
    std::array<Across, 3> across_{};  ///< in the planes yz, zx, xy
    bool empty_ = false;
};

}  // namespace afterglow
