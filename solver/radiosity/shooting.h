#pragma once

// What all shooting solutions share: the loop that sends unshot light out among the patches that take part.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/base/context.h"
#include "solver/radiosity/certificate.h"
#include "solver/radiosity/problem.h"
#include "solver/radiosity/progressive.h"

namespace afterglow {

/// Shoots as `step` does (progressive.h), but only patches for which `active` is not 0 shoot or receive;
/// empty: all. The others keep irradiance and unshot light as they are, and the certificate returned, as well
/// as the state's status, says nothing about them: it counts the unshot light of the active ones alone.
/// Errors: cancelled leaves a consistent state; sizes are not checked.
Certificate shoot_among(ProgressiveState& state, const RadiosityProblem& problem,
                        const FormFactorColumns& columns, const ProgressiveConfig& config,
                        std::span<const std::uint8_t> active, const Context& context);

/// Some patches, in index order, send all their unshot light along their columns, however many entries these
/// hold: one batch, after which the state is `running`. Sums in double, so that many batches without a sweep
/// lose little to rounding. Errors: cancelled leaves the state as it was.
void shoot_at_once(ProgressiveState& state, const RadiosityProblem& problem, const FormFactorColumns& columns,
                   const std::vector<Index>& patches, const Context& context);

/// Throws Error{invalid_input} unless state, columns and configuration fit the problem.
void check_step(const ProgressiveState& state, const RadiosityProblem& problem,
                const FormFactorColumns& columns, const ProgressiveConfig& config);

/// Throws Error{cannot_converge} where the gain is 1 or more.
void check_gain(const Enclosure& enclosure);

}  // namespace afterglow
