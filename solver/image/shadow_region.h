#pragma once

#include <vector>

#include "solver/base/math.h"

namespace afterglow {

/// The points from which something in a box may hide some of a light in another box: those whose hull with
/// the light meets the blocker. Bounded by the blocker's faces and by planes parallel to an axis that touch
/// both boxes and divide them (Haines and Wallace's shafts, 1991, with the viewpoint left open).
/// Conservative: points outside see all of the light past the blocker. Thread-safety: const after
/// construction.
class ShadowRegion {
  public:
    /// `slack_m`: by how much the blocker is grown on every side, for rounding.
    ShadowRegion(const Box& blocker, const Box& light, float slack_m);

    [[nodiscard]] bool holds(const Vec3& point) const;
    /// Whether any point of a box may be in it; an empty box has none.
    [[nodiscard]] bool meets(const Box& points) const;

  private:
    /// A point is outside where dot(normal, point) > offset.
    struct Plane {
        Vec3 normal{0};
        float offset = 0;
    };
    void add_tangents(const Box& blocker, const Box& light, int i, int j);

    std::vector<Plane> planes_;  // none: the boxes touch, and any point may be in shadow
};

}  // namespace afterglow
