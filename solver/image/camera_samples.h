#pragma once

#include <array>
#include <cstdint>

#include "solver/base/sampling.h"
#include "solver/image/camera.h"
#include "solver/image/picture.h"

namespace afterglow {

/// A sample of a pixel.
struct CameraSample {
    int x = 0, y = 0;
    std::size_t k = 0;  ///< its number within the pixel
};

/// What numbers of a sample follow from: the same ones every time a picture is made.
struct SampleNumber {
    std::uint64_t pixel_seed = 0;
    std::size_t k = 0;  ///< within the pixel
};

/// Where in their pixels the samples of a picture lie. Thread-safety: const after construction; `view` must
/// outlive it.
class CameraSamples {
  public:
    CameraSamples(const CameraView& view, const PictureConfig& config);

    [[nodiscard]] SampleNumber number(const CameraSample& sample) const;
    /// The rays of samples 0 to `count` - 1, and their numbers.
    void rays(const std::array<CameraSample, 16>& samples, std::size_t count, RayPacket& rays,
              std::array<SampleNumber, 16>& numbers) const;

  private:
    const CameraView* view_;
    std::uint64_t seed_;
    SobolPoints points_;
};

}  // namespace afterglow
