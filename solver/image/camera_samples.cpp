#include "solver/image/camera_samples.h"

namespace afterglow {

CameraSamples::CameraSamples(const CameraView& view, const PictureConfig& config)
    : view_(&view), seed_(config.seed), points_(most_samples(config)) {}

SampleNumber CameraSamples::number(const CameraSample& sample) const {
    const auto pixel = static_cast<std::uint64_t>(sample.y) * static_cast<std::uint64_t>(view_->width) +
                       static_cast<std::uint64_t>(sample.x);
    return {mixed(seed_, pixel), sample.k};
}

void CameraSamples::rays(const std::array<CameraSample, 16>& samples, std::size_t count, RayPacket& rays,
                         std::array<SampleNumber, 16>& numbers) const {
    std::array<std::uint32_t, 16> index{};
    std::array<std::array<std::uint32_t, 16>, 2> seeds{};
    for (std::size_t lane = 0; lane < count; ++lane) {
        numbers[lane] = number(samples[lane]);
        index[lane] = static_cast<std::uint32_t>(samples[lane].k);
        for (std::size_t d = 0; d < seeds.size(); ++d)
            seeds[d][lane] = SobolPoints::seed_of(numbers[lane].pixel_seed, d);
    }
    std::array<float, 16> across, down;
    points_.at(0, index, seeds[0], across);
    points_.at(1, index, seeds[1], down);
    rays.count = static_cast<Index>(count);
    for (std::size_t lane = 0; lane < count; ++lane)
        rays.set(lane, view_->ray(static_cast<float>(samples[lane].x) + across[lane],
                                  static_cast<float>(samples[lane].y) + down[lane]));
}

}  // namespace afterglow
