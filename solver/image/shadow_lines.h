#pragma once

#include <cstdint>

#include "solver/base/sampling.h"
#include "solver/image/lit_world.h"
#include "solver/image/picture.h"

namespace afterglow {

/// A line from a point to where light comes from, and what it brings if nothing stands between.
struct ShadowLine {
    Rgb irradiance{0};  ///< W/m², its share of the point's direct light; 0: no line
    Vec3 direction{0};  ///< unit, towards the light
    float far_m = 0;    ///< just before the light, which must not block itself

    [[nodiscard]] bool brings_light() const { return max_channel(irradiance) > 0; }
};

/// Which camera sample of which pixel: the same one every time a picture is made.
struct SampleNumber {
    std::uint64_t pixel_seed = 0;
    std::size_t k = 0;  ///< within the pixel
};

/// The lines of a picture from what its camera samples meet to its lights: some to points on lamps, one to
/// each light without a surface. Thread-safety: const after construction; what `lit` points at must outlive
/// it.
class ShadowLines {
  public:
    ShadowLines(const LitWorld& lit, const PictureConfig& config);

    /// Of every point.
    [[nodiscard]] std::size_t count() const { return to_lamps_ + lights_.size(); }
    /// Makes ready for the lines of a point of a surface with a unit normal.
    void look_from(const Vec3& position, const Vec3& normal, DirectLight::Seen& seen) const;
    /// Line i of the point that was last looked from.
    [[nodiscard]] ShadowLine at(std::size_t i, const SampleNumber& sample, DirectLight::Seen& seen) const;

  private:
    const DirectLight* direct_;
    std::span<const LightInPlace> lights_;
    std::size_t to_lamps_ = 0;
    SobolPoints points_;
};

}  // namespace afterglow
