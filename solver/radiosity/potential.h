#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/base/context.h"
#include "solver/radiosity/problem.h"
#include "solver/radiosity/progressive.h"
#include "solver/radiosity/roles.h"

namespace afterglow {

/// The power, W in its largest channel, that each patch could still send on its way to what the observer
/// sees:
///     A_p (|ΔB_p| + ρ_p h) v_p,
/// its unshot light and what it reflects of everybody's, with Cohen's ambient estimate h of |ΔB| as what
/// arrives, times its importance v_p: 1 for a patch that is seen itself, else s + (1 − s) ρ̄ σ, with s the
/// share of its light that falls on seen patches and, for the rest, one more bounce by Chen's form factors
/// (ρ̄ the mean reflectance, σ the seen share of all area). Gathers the rows of the patches not seen.
/// Same bits for any number of threads. Errors: cancelled.
/// Source: the "potential contribution" of Tost and Pueyo 1993, section 3, which gives no formula.
std::vector<double> potential(const RadiosityProblem& problem, std::span<const Rgb> unshot,
                              const PatchRoles& roles, const Context& context);

/// Which patches take part in the light from the start: 1 active, 0 passive. A group of patches of which none
/// is seen is passive if it has little potential. First whole objects are considered, then single surfaces
/// of what is left, so a hidden lamp in a dark body stays active and the dark back of a visible body does
/// not (both of which the report asks for); within either, groups go in order of potential a patch, lowest
/// first, as long as all passive ones together have at most `passive_share` of the whole potential. Where
/// objects or surfaces are not known, every patch is its own. Where nothing is known to be hidden, all are
/// active.
std::vector<std::uint8_t> mark_active(std::span<const double> potential, const PatchRoles& roles,
                                      double passive_share);

}  // namespace afterglow
