#pragma once

#include <vector>

#include "solver/visibility/light_lines.h"

namespace afterglow {

/// What the lines of static receivers see when all actors are away: the *background* of every line.
struct StaticLines {
    LineTargets background;  ///< by sight line of static patches
    std::vector<float>
        light_contribution;  ///< by light line of static patches; those to lamps on actors mean nothing
    Index directions = 0;    ///< how many of each patch's sight lines have been traced
};

/// Room for all lines, nothing traced yet.
StaticLines make_static_lines(const PatchMesh& mesh, const SightLines& sight, const LightLines& light);

/// Traces on to `directions` sight lines a patch; the first call traces the light lines too. Returns the
/// number of rays. Any division into calls gives the same result. Errors: cancelled; the lines traced before
/// stay valid.
std::uint64_t extend_static_lines(StaticLines& lines, const PatchMesh& mesh, const SightLines& sight,
                                  const LightLines& light, const RayCaster& caster, Index directions,
                                  const Context& context);

}  // namespace afterglow
