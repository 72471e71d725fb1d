#include "solver/image/shadow_lines.h"

namespace afterglow {

namespace {

std::size_t lines_to_lamps(const LitWorld& lit, const PictureConfig& config) {
    if (lit.direct == nullptr || lit.direct->empty()) return 0;
    return static_cast<std::size_t>(config.light_samples_per_point);
}

// Lamps themselves must not block.
constexpr float short_of_light = 1 - 1e-4F;

}  // namespace

ShadowLines::ShadowLines(const LitWorld& lit, const PictureConfig& config)
    : direct_(lit.direct),
      lights_(lit.lights),
      to_lamps_(lines_to_lamps(lit, config)),
      points_(most_samples(config) * to_lamps_) {}

void ShadowLines::look_from(const Vec3& position, const Vec3& normal, DirectLight::Seen& seen) const {
    if (to_lamps_ > 0) {
        direct_->look_from(position, normal, seen);
    } else {
        seen.point = position;
        seen.normal = normal;
    }
}

ShadowLine ShadowLines::at(std::size_t i, const SampleNumber& sample, DirectLight::Seen& seen) const {
    if (i < to_lamps_) {
        const Sample4 s = points_.at(sample.k * to_lamps_ + i, mixed(sample.pixel_seed));
        const LightSample light = direct_->sample(seen, s[2], s[0], s[1]);
        return {light.irradiance / static_cast<float>(to_lamps_), light.direction,
                light.distance_m * short_of_light};
    }
    const LightInPlace& placed = lights_[i - to_lamps_];
    const LightAtPoint light = light_at(placed.light, placed.pose, seen.point, seen.normal);
    return {light.irradiance, light.direction, light.distance_m * short_of_light};
}

}  // namespace afterglow
