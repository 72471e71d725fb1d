#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/image/direct_light.h"
#include "solver/image/rectangle_packet.h"

namespace afterglow {

/// A point of the lamps for each of sixteen points, and what it gives if nothing stands between.
struct LampPacketSamples {
    alignas(64) PacketFloats direction_x, direction_y, direction_z;  ///< unit, towards the lamp
    alignas(64) PacketFloats distance_m;                             ///< to the point on the lamp
    alignas(64)
        PacketFloats share;  ///< of the lamp's radiosity that arrives as irradiance; 0: nothing to trace
    alignas(64) std::array<Index, 16> emitter;  ///< which of DirectLight::emitters
};

/// The lamps as sixteen points of surfaces see them: DirectLight::sample for all at once, but for rounding.
/// PacketFloats never set give nothing of use. One thread at a time; `direct` must outlive it.
class LampPacket {
  public:
    explicit LampPacket(const DirectLight& direct);

    /// Puts a point with a unit normal in a lane.
    void set(std::size_t lane, const Vec3& point, const Vec3& normal);
    /// To be called when all lanes are set, before `sample`.
    void look();
    /// `choice`, `s` and `t` in [0,1).
    void sample(const PacketFloats& choice, const PacketFloats& s, const PacketFloats& t,
                LampPacketSamples& out);

  private:
    /// One lamp from all points.
    struct Sight {
        alignas(64) PacketFloats weight;  ///< how often it is chosen, beside others
        RectanglePacket view;             ///< of a rectangle
        bool is_viewed = false;           ///< whether it has been made, which is done when first needed
    };

    void look_at(const DirectLight::Emitter& emitter, Sight& sight) const;
    void choose(const PacketFloats& choice, std::array<Index, 16>& chosen, PacketFloats& rest);
    void place_on_rectangle(Index emitter, const std::array<Index, 16>& chosen, const PacketFloats& s,
                            const PacketFloats& t);
    void place_on_patches(Index emitter, std::size_t lane, float choice, float s, float t);

    const DirectLight* direct_;
    PointPacket points_{};
    std::vector<Sight> sights_;       // by emitter
    alignas(64) PacketFloats sum_{};  // of weights
    alignas(64) PacketFloats weight_{};
    PlacePacket places_{};
};

}  // namespace afterglow
