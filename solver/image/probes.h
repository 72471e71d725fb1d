#pragma once

#include <cstdint>

#include "solver/image/path.h"

// How far a picture is off, by path tracing a few of its pixels.

namespace afterglow {

struct ProbeConfig {
    int pixels = 128;  ///< probed, more of them where the picture is uneven; a smaller picture: all of its
    int parts = 16;    ///< independent estimates of a pixel on average, 2 or more; more of noisy ones
    int samples_per_part = 16;  ///< camera samples of each, one shadow ray to the lamps from each
    int paths_per_sample = 3;   ///< for the light that does not come straight from a lamp
    std::uint64_t seed = 1;     ///< of the choice of pixels and of all samples
    /// Paths may end early: more but shorter ones tell more for their time.
    PathConfig path = {.sure_bounces = 1};
    int pilot_samples = 16;  ///< of each pixel first, one path each, 2 or more: how noisy it is
};

/// What probes say of a picture.
struct ProbeEstimate {
    /// Root mean square error of radiance relative to the picture's root mean square radiance; 0 where
    /// the unbiased estimate of its square is negative.
    double relative_error = 0;
    /// How far up one standard error of the square takes `relative_error`; from the spread over pixels.
    double standard_error = 0;
    double left_out_share = 0;  ///< of the probed pixels: those within one pixel of a visible lamp, 0 to 1
};

/// Estimates the error of a picture of `scene` seen by `view`. Of a pixel's value I and independent unbiased
/// estimates A and B of what it should be, (I−A)(I−B) is on average the square of its error: noise
/// cancels, and so all pairs of `parts` are averaged. Within a part the samples are stratified, as the light
/// of many shadow rays and of the first bounce is then less noisy than that of as many independent
/// paths. Pixels near a lamp are left out, whose edges would drown all else. Adds the number of rays to
/// `rays_traced`. Same bits for any number of threads. Errors: invalid_input for counts below those in
/// ProbeConfig and for a picture that is empty or of another size than the view's; cancelled.
ProbeEstimate estimate_error(const Picture& picture, const CameraView& view, const PathScene& scene,
                             const ProbeConfig& config, std::uint64_t& rays_traced, const Context& context);

}  // namespace afterglow
