#pragma once

#include "solver/base/pixels.h"

namespace afterglow::test {

/// How far a picture is from a reference that comes as two independent noisy halves.
struct PictureError {
    double relative_rmse = 0;  ///< root of the unbiased estimate, 0 where that is negative
    double used_share = 0;     ///< pixels that counted, 0 to 1
};

/// relative RMSE² = mean((I−A)(I−B)) / mean(A·B) over pixels and channels. The noise of A and B is
/// independent, so its products vanish on average and a noisy reference does not inflate the error. Left out
/// are the pixels within one pixel (8-neighbourhood) of one where any channel of A or B is above
/// `lamp_radiance`: the edges of a bright lamp would drown all else. Errors: std::invalid_argument for
/// pictures of different or no size, for non-finite pixels, or where no pixel is left or the halves are
/// black.
PictureError picture_error(const Picture& picture, const Picture& half_a, const Picture& half_b,
                           double lamp_radiance = 2.5);

}  // namespace afterglow::test
