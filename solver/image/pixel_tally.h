#pragma once

#include <algorithm>

#include "solver/base/math.h"

namespace afterglow {

/// What the samples of a pixel have given so far.
struct PixelTally {
    Rgb sum{0};
    float squares = 0;  ///< of luminance
    int count = 0;
    Index surface = no_index;
    bool sees_several = false;

    /// `met` as SeenPoint::surface.
    void add(const Rgb& radiance, Index met) {
        const float luminance = luminance_of(radiance);
        sum += radiance;
        squares += luminance * luminance;
        if (count > 0 && met != surface) sees_several = true;
        surface = met;
        ++count;
    }
    /// Whether the pixel needs more samples, `noise` as in PictureConfig.
    [[nodiscard]] bool is_noisy(float noise) const {
        if (sees_several) return true;
        const auto n = static_cast<float>(count);
        const float mean = luminance_of(sum) / n;
        const float variance = std::max(0.0F, squares / n - mean * mean) / std::max(1.0F, n - 1);
        return variance > noise * noise * mean * mean;
    }
    [[nodiscard]] Rgb mean() const { return sum / static_cast<float>(count); }

  private:
    static float luminance_of(const Rgb& c) { return 0.2126F * c.r + 0.7152F * c.g + 0.0722F * c.b; }
};

}  // namespace afterglow
