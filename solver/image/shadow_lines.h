#pragma once

#include <cstdint>

#include "solver/image/camera_samples.h"
#include "solver/image/lamp_packet.h"
#include "solver/image/lit_world.h"

namespace afterglow {

/// The lines of a picture from what its camera samples meet to its lights: some to points on lamps, one to
/// each light without a surface. Thread-safety: const after construction; what `lit` points at must outlive
/// it.
class ShadowLines {
  public:
    ShadowLines(const LitWorld& lit, const PictureConfig& config);

    /// Of every point.
    [[nodiscard]] std::size_t count() const { return to_lamps_ + lights_.size(); }

  private:
    friend class ShadowPacket;
    const DirectLight* direct_;
    std::span<const LightInPlace> lights_;
    std::size_t to_lamps_ = 0;
    SobolPoints points_;
};

/// A shadow line of each of sixteen points.
struct ShadowLinePacket {
    RayPacket rays;            ///< end just before the light, which must not block itself
    std::array<Rgb, 16> gain;  ///< irradiance of lanes alive if nothing stands between, W/m²
    std::uint32_t alive = 0;   ///< bit k: lane k has a line that can bring light; others are switched off
};

/// Sixteen points whose shadow lines are made together. One thread at a time; the lines must outlive it.
class ShadowPacket {
  public:
    explicit ShadowPacket(const ShadowLines& lines);

    /// Puts a point of a surface with a unit normal in a lane.
    void set(std::size_t lane, const Vec3& position, const Vec3& normal, const SampleNumber& sample);
    /// To be called when lanes 0 to `count` - 1 are set, before `at`.
    void look(std::size_t count);
    /// Line i of the points whose bit is set in `wanted`.
    void at(std::size_t i, std::uint32_t wanted, ShadowLinePacket& out);

  private:
    void to_lamps(std::size_t i, std::uint32_t wanted, ShadowLinePacket& out);
    void to_light(const LightInPlace& placed, std::uint32_t wanted, ShadowLinePacket& out) const;
    void put(std::size_t lane, const Vec3& direction, float far_m, ShadowLinePacket& out) const;

    const ShadowLines* lines_;
    std::optional<LampPacket> lamps_;  // none: no lamp is on
    std::array<Vec3, 16> position_{}, normal_{};
    std::array<std::uint32_t, 16> number_{};                   // of each point's first line among the points
    std::array<std::array<std::uint32_t, 16>, 3> scramble_{};  // by dimension
    std::size_t count_ = 0;
    LampPacketSamples samples_;
};

}  // namespace afterglow
