#pragma once

#include <span>

#include "solver/base/pixels.h"

namespace afterglow::testing {

/// How much a sequence of pictures flickers beside the true ones: the root mean square, over inner frames,
/// pixels and channels, of the second difference in time of (shown − truth), divided by √6 and by the mean of
/// the truth. Independent noise of relative deviation s in every frame has flicker s; whatever error stays
/// the same or changes evenly has none. `block`: means over block × block pixels are taken first, 1 or more;
/// incomplete blocks are left out. At least three frames, all of one size. Errors: std::invalid_argument.
double flicker(std::span<const Picture> shown, std::span<const Picture> truth, int block);

}  // namespace afterglow::testing
