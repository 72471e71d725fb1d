#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/base/context.h"
#include "solver/base/math.h"
#include "solver/formfactor/matrix.h"
#include "solver/radiosity/progressive.h"

namespace afterglow {

/// A progressive solution that can follow its problem: it remembers what it was solved for, so a caller keeps
/// one state for a whole animation and no old problem. Step it as any progressive state (`step`).
/// Source: Chen 1990, "Incremental radiosity".
struct IncrementalState : ProgressiveState {
    std::vector<Rgb> emission, reflectance, external_irradiance;  ///< of the problem it stands for, by patch
    std::vector<double> row_sum;                                  ///< Σ_j F_ij, by patch
};

/// How to step after a change: the counted rounding ends it, and a batch spans a factor of 16, since where
/// little is to be shot the passes over all patches between batches cost the most.
ProgressiveConfig following_config(double asked_error);

/// Starts cold, as make_progressive_state, with the same errors.
IncrementalState make_incremental_state(const RadiosityProblem& problem, const Context& context = Context(1));

/// Rows that differ between two matrices of the same patches, in increasing order: the fallback of a caller
/// who does not know them. Compares entry by entry in the order stored, so the same factors in another order
/// count as a change. Errors: invalid_input where the numbers of rows differ.
std::vector<Index> changed_rows(const FormFactorMatrix& before, const FormFactorMatrix& after,
                                const Context& context);

/// Makes the state stand for another problem of the same patches. What patches have shot, S = B − ΔB, stays
/// as it is; what it brings to the new surfaces along the new rows is what they now receive, and all that B
/// gains or loses by it is unshot:
///     H' = F' S + H0',   ΔB' = ΔB + (E' + ρ'H') − (E + ρH).
/// For a row that changed, Chen's H + ΔF S, term by term the same, is gathered afresh instead: half the
/// entries, no old row, and no rounding carried along. Nothing is divided by ρ, so light comes back after ρ =
/// 0. A channel in which nothing shines any more is dark at once, rounding and all. Since S and F' are never
/// negative, neither is H', nor any H on the way, but for rounding.
///
/// `rows`: receivers whose form factors changed, in any order; the caller's promise that all others are as
/// they were. Cost: these rows, those of patches whose reflectance grew (their rounding was counted at less),
/// and a few passes over the patches. If nothing changed at all, the state keeps every bit and its status.
/// Same bits for any number of threads. Errors: invalid_input, cannot_converge, cancelled; the state is then
/// as before.
void change(IncrementalState& state, const RadiosityProblem& problem, std::span<const Index> rows,
            const Context& context);

/// The same where only patches for which `active` is not 0 receive: the others keep their H, but for the
/// difference of H0, whatever their rows say. Empty: all receive. False if nothing changed at all.
bool change_among(IncrementalState& state, const RadiosityProblem& problem, std::span<const Index> rows,
                  std::span<const std::uint8_t> active, const Context& context);

/// Forgets what rounding has added up to: sets the irradiance of all patches as `receive` does. The state
/// must stand for `problem`.
void refresh(IncrementalState& state, const RadiosityProblem& problem, const Context& context);

/// Sets the irradiance of some patches to what has been shot along their rows, F S + H0, and makes unshot
/// what their radiosity gains by it. The state must stand for `problem`.
void receive(IncrementalState& state, const RadiosityProblem& problem, std::span<const Index> patches,
             const Context& context);

}  // namespace afterglow
