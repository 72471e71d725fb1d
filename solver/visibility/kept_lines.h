#pragma once

#include <cstdint>
#include <span>

#include "solver/visibility/static_pass.h"

namespace afterglow {

/// What is left of a static pass when the furniture has changed.
struct KeptFurniture {
    const StaticLines& lines;            ///< all of them, before the change
    Index patches = 0;                   ///< static ones, before it
    std::span<const std::uint8_t> kept;  ///< by static patch now: whether shape and number are as before
    std::span<const Box> changed;        ///< where anything stood or stands that came, went or moved
    bool same_lamps = false;             ///< and so the light lines of kept patches are the same
};

/// The whole static pass after a change of the furniture: a line whose patch was kept, and which up to what
/// it saw met no changed place and ends on a kept patch, keeps what it saw; all others are traced. `caster`,
/// `mesh` and lines are those of now. The lines must be lifted as far as before. Returns the number of rays;
/// the result is what tracing all of them gives. Errors: cancelled.
std::uint64_t retrace_changed_lines(const KeptFurniture& before, StaticLines& lines, const PatchMesh& mesh,
                                    const SightLines& sight, const LightLines& light, const RayCaster& caster,
                                    const Context& context);

}  // namespace afterglow
