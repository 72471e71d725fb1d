#include "solver/image/shadow_lines.h"

#include <bit>

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

ShadowPacket::ShadowPacket(const ShadowLines& lines) : lines_(&lines) {
    if (lines.to_lamps_ > 0) lamps_.emplace(*lines.direct_);
}

void ShadowPacket::set(std::size_t lane, const Vec3& position, const Vec3& normal,
                       const SampleNumber& sample) {
    position_[lane] = position;
    normal_[lane] = normal;
    if (!lamps_) return;
    lamps_->set(lane, position, normal);
    number_[lane] = static_cast<std::uint32_t>(sample.k * lines_->to_lamps_);
    const std::uint64_t seed = mixed(sample.pixel_seed);
    for (std::size_t d = 0; d < scramble_.size(); ++d) scramble_[d][lane] = SobolPoints::seed_of(seed, d);
}

void ShadowPacket::look(std::size_t count) {
    count_ = count;
    if (lamps_) lamps_->look();
}

void ShadowPacket::at(std::size_t i, std::uint32_t wanted, ShadowLinePacket& out) {
    out.rays.count = static_cast<Index>(count_);
    out.alive = 0;
    if (i < lines_->to_lamps_)
        to_lamps(i, wanted, out);
    else
        to_light(lines_->lights_[i - lines_->to_lamps_], wanted, out);
}

void ShadowPacket::to_lamps(std::size_t i, std::uint32_t wanted, ShadowLinePacket& out) {
    std::array<std::uint32_t, 16> number;
    for (std::size_t lane = 0; lane < number.size(); ++lane)
        number[lane] = number_[lane] + static_cast<std::uint32_t>(i);
    alignas(64) PacketFloats choice, s, t;
    lines_->points_.at(2, number, scramble_[2], choice);
    lines_->points_.at(0, number, scramble_[0], s);
    lines_->points_.at(1, number, scramble_[1], t);
    lamps_->sample(choice, s, t, samples_);
    const auto emitters = lines_->direct_->emitters();
    const float share = 1 / static_cast<float>(lines_->to_lamps_);
    for (std::size_t lane = 0; lane < count_; ++lane) {
        const bool lit = ((wanted >> lane) & 1U) != 0 && samples_.share[lane] > 0;
        const Vec3 direction(samples_.direction_x[lane], samples_.direction_y[lane],
                             samples_.direction_z[lane]);
        put(lane, lit ? direction : Vec3(0, 0, 1), lit ? samples_.distance_m[lane] * short_of_light : 0, out);
        if (!lit) continue;
        out.gain[lane] = samples_.share[lane] * share * emitters[samples_.emitter[lane]].emission;
        out.alive |= 1U << lane;
    }
}

void ShadowPacket::to_light(const LightInPlace& placed, std::uint32_t wanted, ShadowLinePacket& out) const {
    for (std::size_t lane = 0; lane < count_; ++lane) {
        LightAtPoint light;
        if (((wanted >> lane) & 1U) != 0)
            light = light_at(placed.light, placed.pose, position_[lane], normal_[lane]);
        const bool lit = max_channel(light.irradiance) > 0;
        put(lane, lit ? light.direction : Vec3(0, 0, 1), lit ? light.distance_m * short_of_light : 0, out);
        if (!lit) continue;
        out.gain[lane] = light.irradiance;
        out.alive |= 1U << lane;
    }
}

/// A ray that ends where it starts is switched off.
void ShadowPacket::put(std::size_t lane, const Vec3& direction, float far_m, ShadowLinePacket& out) const {
    out.rays.set(lane, {position_[lane], direction, far_m});
}

}  // namespace afterglow
