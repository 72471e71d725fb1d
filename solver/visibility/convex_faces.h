#pragma once

#include <array>
#include <vector>

#include "solver/scene/world.h"

namespace afterglow {

/// A triangle of a body, or two that lie in one plane and make a convex quadrangle.
struct ConvexFace {
    std::array<Vec3, 4> corners{};  ///< as they run round, body frame
    Index count = 0;                ///< of corners: 3 or 4
    Index triangle = 0;
    Index second_triangle = no_index;  ///< the one across the diagonal from corner 0 to corner 2
    Vec3 normal{0};                    ///< of the front; not unit, 0 where there is no area
    Vec3 to_second{0};                 ///< across the diagonal, towards the second triangle

    /// The triangle that a point of the face lies on.
    [[nodiscard]] Index triangle_at(const Vec3& point) const {
        return glm::dot(point - corners[0], to_second) > 0 ? second_triangle : triangle;
    }
};

/// All triangles of a body, each in one face. Two are joined only if they face the same way, their corners
/// lie in one plane up to rounding, and no corner of the outline is straight or turns inwards; the outline is
/// theirs, bit for bit. Thread-safety: pure.
std::vector<ConvexFace> convex_faces(const Body& body);

}  // namespace afterglow
