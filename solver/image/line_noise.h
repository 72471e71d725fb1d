#pragma once

#include <cstdint>

#include "solver/image/picture.h"

namespace afterglow {

/// How much of a picture's error is the noise of the patches' sight lines: the root mean square of
/// `lit.irradiance`, here the noise of the patches (see half_differences), interpolated and reflected to the
/// camera, relative to that of the picture. Looked at along one ray for each of some thousand pixels, spread
/// evenly; those that see a light are left out. 0 for a dark picture. Adds the number of rays to
/// `rays_traced`. Same bits for any number of threads. Errors: cancelled.
double line_noise(const Picture& picture, const CameraView& view, const LitWorld& lit,
                  std::uint64_t& rays_traced, const Context& context);

}  // namespace afterglow
