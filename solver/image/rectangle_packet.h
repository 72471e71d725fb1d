#pragma once

#include <array>

#include "solver/image/rectangle_light.h"

namespace afterglow {

/// Sixteen numbers, one a lane.
using PacketFloats = std::array<float, 16>;

/// Sixteen points of surfaces with their unit normals, world.
struct PointPacket {
    alignas(64) PacketFloats x, y, z, normal_x, normal_y, normal_z;
};

/// Places on lamps, and the solid angle that each stands for, as in RectanglePoint.
struct PlacePacket {
    alignas(64) PacketFloats x, y, z, solid_angle;
};

/// RectangleSight::expected of each point. Thread-safety: pure.
PacketFloats expected_of(const RectangleLight& light, const PointPacket& points);

/// A rectangle as sixteen points see it, whose places are chosen as `point_for` chooses them, in single
/// precision. Where the rectangle is seen so edge-on that this would tell they are chosen as from far off,
/// which is right, too. One thread at a time.
class RectanglePacket {
  public:
    /// From all points, whatever stands in lanes out of use; to be called before `place`.
    void look(const RectangleLight& light, const PointPacket& points);
    /// The places for (s, t) in [0,1)² of those lanes where `chosen` is `by`; others keep what they have.
    void place(const RectangleLight& light, const PointPacket& points, const std::array<Index, 16>& chosen,
               Index by, const PacketFloats& s, const PacketFloats& t, PlacePacket& out) const;

  private:
    // The rectangle in its own frame around each point, as in Ureña et al.
    alignas(64) PacketFloats x0_{}, y0_{}, height_{};
    alignas(64) PacketFloats b0_{}, b1_{}, k_{};
    alignas(64) PacketFloats solid_angle_{};  // 0: uniform in area
    alignas(64) PacketFloats w00_{}, w10_{}, w01_{}, w11_{};
};

}  // namespace afterglow
