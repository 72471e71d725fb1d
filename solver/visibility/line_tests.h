#pragma once

#include "solver/visibility/ray_caster.h"

namespace afterglow {

/// Sixteen lines made ready for tests against boxes.
struct LinePacket {
    RayPacket rays;
    alignas(64) std::array<float, 16> inverse_x, inverse_y, inverse_z;  ///< of the directions; finite

    /// Bits of all lanes in use.
    [[nodiscard]] std::uint32_t all() const { return (1U << rays.count) - 1U; }
    /// To be called after the rays have been set; also makes lanes past `count` harmless.
    void prepare();
};

/// The rays as a body sees them that stands at a pose. Distances stay what they are.
void to_body(const RayPacket& rays, const Pose& pose, LinePacket& out);

/// Bits of the lanes whose line meets a box before its own `far`; lines that touch it count.
std::uint32_t lanes_through(const LinePacket& lines, const Box& box);

/// A triangle made ready for tests against lines.
struct LineFace {
    Vec3 a{0}, b{0}, c{0};
    Vec3 normal{0};  ///< of the front, not unit

    LineFace() = default;
    LineFace(const Vec3& first, const Vec3& second, const Vec3& third)
        : a(first), b(second), c(third), normal(glm::cross(second - first, third - first)) {}
};

/// Two axes across each line: seen along them the line is a point.
struct LineAxes {
    alignas(64) std::array<float, 16> u_x, u_y, u_z, v_x, v_y, v_z;

    explicit LineAxes(const RayPacket& rays);
};

/// Where each line meets the plane of a triangle, metres; infinite where it misses the triangle or meets it
/// behind its origin. Lines through an edge or a corner that triangles share meet at least one of them,
/// unless they lie in its plane but for rounding: a corner lies at the same place across the line for all its
/// triangles, and on which side of a point an edge between two places passes is computed without error, or as
/// zero, which counts as met. Source: Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection",
/// with axes for each line. `axes` are those of `rays`.
void meet(const RayPacket& rays, const LineAxes& axes, const LineFace& face, std::array<float, 16>& distance);

}  // namespace afterglow
