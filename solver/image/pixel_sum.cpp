#include "solver/image/pixel_sum.h"

#include <algorithm>

namespace afterglow {

namespace {

float luminance_of(const Rgb& c) {
    return 0.2126F * c.r + 0.7152F * c.g + 0.0722F * c.b;
}

}  // namespace

bool PixelTotals::is_noisy(float noise, const Rgb& patch_light) const {
    if (sees_several) return true;
    const auto n = static_cast<float>(count);
    const float by_patches = luminance_of(patch_light);
    const float mean = (constant_lum + by_patches) / n;
    const float irradiance = reflected_lum > 0 ? by_patches / reflected_lum : 0;
    const float squares =
        constant_squared + 2 * irradiance * product + irradiance * irradiance * reflected_squared;
    const float variance = std::max(0.0F, squares / n - mean * mean) / std::max(1.0F, n - 1);
    return variance > noise * noise * mean * mean;
}

bool may_miss_light(const TileTotals& tile, std::size_t pixel) {
    const PixelTotals& dark = *tile[pixel];
    if (dark.is_lit || !(dark.reflected_lum > 0)) return false;
    constexpr std::size_t edge = PictureTiles::edge;
    const std::size_t x = pixel % edge, y = pixel / edge;
    for (std::size_t v = y - std::min<std::size_t>(y, 1); v < std::min(y + 2, edge); ++v)
        for (std::size_t u = x - std::min<std::size_t>(x, 1); u < std::min(x + 2, edge); ++u) {
            const PixelTotals* other = tile[v * edge + u];
            if (other != nullptr && other->is_lit && other->surface == dark.surface) return true;
        }
    return false;
}

void PixelSum::clear() {
    totals_ = {};
    patches_.clear();
    last_ = 0;
}

void PixelSum::add(const SampleLight& sample, std::span<const float> confidence) {
    PixelTotals& t = totals_;
    const Rgb reflected = sample.reflectance / pi;
    const Rgb constant = sample.emitted + reflected * sample.direct;
    const float a = luminance_of(constant), b = luminance_of(reflected);
    t.constant += constant;
    t.constant_lum += a;
    t.reflected_lum += b;
    t.constant_squared += a * a;
    t.product += a * b;
    t.reflected_squared += b * b;
    if (t.count > 0 && sample.surface != t.surface) t.sees_several = true;
    t.surface = sample.surface;
    if (max_channel(sample.direct) > 0) t.is_lit = true;
    ++t.count;

    float whole = 0;
    for (const PatchWeight& entry : sample.patches) whole += entry.weight * confidence[entry.patch];
    if (!(whole > 0)) return;
    for (const PatchWeight& entry : sample.patches) {
        const Rgb share = entry.weight * confidence[entry.patch] / whole * reflected;
        // Neighbouring samples meet the same patches in the same order.
        for (std::size_t tried = 0;; ++tried) {
            last_ = last_ + 1 < patches_.size() ? last_ + 1 : 0;
            if (tried == patches_.size()) {
                last_ = patches_.size();
                patches_.push_back({entry.patch, share});
                break;
            }
            if (patches_[last_].patch == entry.patch) {
                patches_[last_].share += share;
                break;
            }
        }
    }
}

Rgb light_of(std::span<const PatchShare> patches, std::span<const Rgb> irradiance) {
    Rgb sum(0);
    for (const PatchShare& entry : patches) sum += entry.share * irradiance[entry.patch];
    return sum;
}

}  // namespace afterglow
