#pragma once

#include <cstdint>
#include <vector>

#include "solver/base/context.h"
#include "solver/base/pixels.h"

namespace afterglow {

/// The sRGB code value, in [0, 1], of a linear value; below 0 gives 0 and above 1 gives 1.
/// Source: IEC 61966-2-1, the exact two-part curve. Thread-safety: pure.
double srgb_encoded(double linear);

/// Stops by which a picture of linear radiance must be brightened so that its middle tones look mid-bright:
///
///     ev = log2(0.18) − mean of log2(Y) over the middle 80 % of the pixels with Y > 0, sorted by Y,
///
/// Y = 0.2126 R + 0.7152 G + 0.0722 B. A grey of that mean comes out at 0.46 in sRGB; lamps, which are few
/// and bright, and gaps in the scene, which are black, have no say. The result is clamped to ±64 stops, and
/// is 0 for a picture without light. Errors: std::logic_error naming a pixel that is not finite.
/// Thread-safety: pure, and the same bits for the same picture.
float automatic_exposure_ev(const Picture& picture);

/// 8-bit sRGB (width × height × 3) of a picture of linear radiance, brightened by 2^exposure_ev and rounded
/// to the nearest code; what is brighter than white is clipped channel by channel. Errors: std::logic_error
/// naming a pixel that is not finite, since only a defect of ours makes one; cancelled. Thread-safety: pure.
std::vector<std::uint8_t> to_srgb(const Picture& picture, float exposure_ev, const Context& context);

}  // namespace afterglow
