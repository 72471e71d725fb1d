#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "solver/base/context.h"
#include "solver/base/math.h"
#include "solver/formfactor/matrix.h"
#include "solver/radiosity/certificate.h"
#include "solver/radiosity/problem.h"
#include "solver/radiosity/roles.h"
#include "solver/radiosity/shooting_order.h"

namespace afterglow {

/// How a solution ends.
enum class Finish {
    sweep,  ///< a last sweep over all rows confirms the certificate and forgets all rounding: for cold starts
    bound,  ///< the counted rounding does: for small changes, so that the cost follows the change. Patches
            ///< with so little unshot light that the promise does not need it keep it, and a sweep is made
            ///< only for large batches and where rounding takes a tenth of what was asked
};

/// How far and how to solve.
struct ProgressiveConfig {
    double asked_error = 0.02;  ///< certificate (error_bound) at which the solution is finished, above 0
    /// Shots after which a call returns. The batch in hand is always completed, and a call makes at least
    /// one: what is computed never depends on how the shots are divided over calls.
    std::uint64_t max_shots = std::numeric_limits<std::uint64_t>::max();
    ShootingOrder order = ShootingOrder::threshold_scan;  ///< see ShootingOrder
    /// A batch whose columns hold at least this share of all entries is made as a sweep instead: every patch
    /// shoots, and the rows gather it in parallel. Above 1: only for the final check. See README.md for
    /// figures.
    double sweep_share = 0.25;
    /// Patches shoot together that contribute at least this share of what the best one does, above 0 to 1. A
    /// half is the factor of two of the orders; less makes fewer batches, each of which passes over all
    /// patches.
    double batch_share = 0.5;
    Finish finish = Finish::sweep;  ///< see Finish
    PatchRoles roles;               ///< for the orders that ask for them; they outlive the call
};

/// Where the solution stands.
enum class ProgressiveStatus {
    running,    ///< more shots would help
    converged,  ///< the certificate is met
    exhausted,  ///< only rounding is left, and the certificate asked for is finer than single precision can
                ///< give
};

/// The latest run of sweeps over which unshot light must shrink.
struct PolishingRun {
    std::uint64_t sweeps = 0;   ///< made so far
    float unshot_at_start = 0;  ///< largest |ΔB| after the first of them, W/m²
};

/// A solution on its way. B = E + ρH is what is shown; H and not B is kept, so that ρ = 0 needs no division.
/// Between steps H = F (B − unshot) + H0 but for rounding. In float, because a sum's many small terms are
/// added up in double or in short runs before they meet the large value here, and each sweep computes H
/// afresh.
struct ProgressiveState {
    std::vector<Rgb> irradiance;  ///< H, W/m², by patch
    std::vector<Rgb> unshot;    ///< ΔB, W/m², by patch: light of B not yet sent out; below 0: sent too much
    Enclosure enclosure;        ///< of the problem
    std::uint64_t shots = 0;    ///< patches that have shot, over all batches
    std::uint64_t sweeps = 0;   ///< batches that were made as sweeps
    std::uint64_t entries = 0;  ///< form factors used, over all batches
    /// Bound of ρ |H − F (B − unshot) − H0| over patches and channels, W/m²: what single precision has lost.
    double rounding = 0;
    ProgressiveStatus status = ProgressiveStatus::running;  ///< see ProgressiveStatus
    bool polishing = false;  ///< only sweeps from here on: the certificate is near
    PolishingRun run;        ///< while polishing
};

/// Starts cold: H = H0 and everything emitted or reflected of it is unshot.
/// Errors: invalid_input naming the field and patch; cannot_converge where the gain is 1 or more, since the
/// light would grow without bound. Sums all rows once, on the context's threads.
ProgressiveState make_progressive_state(const RadiosityProblem& problem, const Context& context = Context(1));

/// Shoots until the certificate is met (status converged), nothing but rounding is left (exhausted), or
/// `config.max_shots` more shots were made. A finished state returns at once. Loop on `status`.
/// Returns the certificate of E + ρH from the bound ‖r‖∞ ≤ g ‖ΔB‖∞ + rounding: r = ρ (F ΔB − ε), with ε the
/// rounding that the state counts batch by batch. Irradiance below 10⁻²⁰ of the brightest light is taken as
/// none. `columns` must be columns_of(problem.form_factors), the problem that of the state. Same bits for any
/// number of threads and any division into calls. Source: Cohen et al. 1988, section 3. Errors:
/// invalid_input; cancelled leaves a consistent state.
Certificate step(ProgressiveState& state, const RadiosityProblem& problem, const FormFactorColumns& columns,
                 const ProgressiveConfig& config, const Context& context);

/// A solution and its promise.
struct ProgressiveSolution {
    ProgressiveState state;
    Certificate certificate;
};

/// One call: a cold start and steps until finished (or `config.max_shots`). Errors as above.
ProgressiveSolution solve_progressive(const RadiosityProblem& problem, const FormFactorColumns& columns,
                                      const ProgressiveConfig& config, const Context& context);

}  // namespace afterglow
