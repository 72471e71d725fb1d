#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/image/picture_tiles.h"
#include "solver/mesh/interpolation.h"

namespace afterglow {

/// A patch and by how much its irradiance is seen: radiance, W/m²/sr, per W/m².
struct PatchShare {
    Index patch = no_index;
    Rgb share{0};
};

/// What a camera sample meets, as far as its pixel is concerned.
struct SampleLight {
    Rgb emitted{0};                        ///< radiance, W/m²/sr
    Rgb reflectance{0};                    ///< 0: the rest is of no consequence
    Rgb direct{0};                         ///< irradiance that does not come by patches, W/m²
    Index surface = no_index;              ///< as SeenPoint::surface
    std::span<const PatchWeight> patches;  ///< whose irradiance is interpolated, before their confidence
};

/// Some samples of a pixel added up: their radiance as a function of the irradiance of patches, which is
/// linear, so that light may change without the samples being looked at. Every picture is made this way.
struct PixelTotals {
    Rgb constant{0};  ///< what they emit and reflect of direct light
    int count = 0;
    Index surface = no_index;
    bool sees_several = false;
    bool is_lit = false;  ///< any sample takes light that does not come by patches
    /// Moments of what is constant in a sample and of its reflectance over π, as luminance.
    float constant_lum = 0, reflected_lum = 0, constant_squared = 0, product = 0, reflected_squared = 0;

    /// Whether the pixel needs more samples: their surfaces differ, or the standard error of the mean is
    /// above `noise` of it. `patch_light` is what patches add to `constant`; within a pixel they light alike.
    [[nodiscard]] bool is_noisy(float noise, const Rgb& patch_light) const;
};

/// The first samples of four rows of four pixels; null where the picture ends.
using TileTotals = std::array<const PixelTotals*, PictureTiles::edge * PictureTiles::edge>;

/// Whether none of a pixel's samples takes light straight from a lamp, though a pixel beside it, of the same
/// tile, has some on the same surface: it may lie where a little of a lamp is seen, and samples that all miss
/// that look free of noise. Thread-safety: pure.
bool may_miss_light(const TileTotals& tile, std::size_t pixel);

/// Totals with their patches, each once, in the order in which they are met.
class PixelSum {
  public:
    void clear();
    /// `confidence` by patch.
    void add(const SampleLight& sample, std::span<const float> confidence);

    [[nodiscard]] const PixelTotals& totals() const { return totals_; }
    [[nodiscard]] std::span<const PatchShare> patches() const { return patches_; }

  private:
    PixelTotals totals_;
    std::vector<PatchShare> patches_;
    std::size_t last_ = 0;  // where the patch added last stands
};

/// A pixel's radiance, from two sums over its samples (`further` may have none) and what patches add to each.
inline Rgb mean_of(const PixelTotals& first, const Rgb& first_light, const PixelTotals& further,
                   const Rgb& further_light) {
    const Rgb sum = first.constant + first_light + further.constant + further_light;
    return sum / static_cast<float>(first.count + further.count);
}

/// What patches of such irradiance add to a sum, W/m²/sr. Thread-safety: pure.
Rgb light_of(std::span<const PatchShare> patches, std::span<const Rgb> irradiance);

}  // namespace afterglow
