#pragma once

#include <cstdint>
#include <optional>

#include "solver/sequence/parts.h"

namespace afterglow {

/// What comes into view: groups of patches that the camera sees in a frame or in the frames after it, as many
/// as the settings say; in this frame alone where bodies move, since these are looked at where they stand
/// now. A group counts as seen where one of 160 × 90 rays a frame meets a surface to whose light one of its
/// patches is interpolated: what lies between rays is mostly of the same group. `before`: an earlier view of
/// the same rows, whose groups are kept. Adds the number of rays to `rays_traced`. Errors: cancelled.
KeptView look_ahead(const SequenceState::Parts& parts, const FormFactorMatrix& rows,
                    std::optional<KeptView> before, int frame, std::uint64_t& rays_traced,
                    const Context& context);

}  // namespace afterglow
