#pragma once

#include <span>
#include <vector>

#include "solver/formfactor/rows.h"

namespace afterglow {

/// Half the difference between the irradiance that the first and the second half of each patch's sight lines
/// gather, by patch, W/m²; signed, so that interpolating it lets the noise of neighbours cancel as it does in
/// a picture. Its square is on average the variance of what both halves give together where they are
/// independent. They are parts of one well-spread sequence, and better together than that: it is rather too
/// large than too small. Lines to lamps are left out: a picture takes that light point by point. Patches one
/// of whose halves says nothing: 0. `radiosity` by patch and `outside`, from where there is no patch, W/m².
/// Same result for any number of threads. Errors: cancelled.
std::vector<Rgb> half_differences(const SightLines& lines, const Lamps& lamps, const SeenLines& seen,
                                  const FormFactors& factors, std::span<const Rgb> radiosity,
                                  const Rgb& outside, const Context& context);

}  // namespace afterglow
