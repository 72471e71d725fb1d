#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "solver/base/context.h"
#include "solver/radiosity/certificate.h"
#include "solver/radiosity/incremental.h"
#include "solver/radiosity/roles.h"

namespace afterglow {

/// What is solved.
enum class Goal {
    whole,   ///< passive patches are activated until the certificate of all patches is met
    active,  ///< the light among the active patches only; what is withheld from the rest stays so
};

/// How far and how to solve with passive patches.
struct ActivePassiveConfig {
    double asked_error = 0.02;    ///< certificate at which the solution is finished, above 0; see `step`
    Goal goal = Goal::whole;      ///< see Goal
    double passive_share = 0.02;  ///< of all potential that passive patches may have in sum, 0 to 1
    /// Passive patches activated together where nothing else is to be done. 1 is the report's loop; each
    /// cycle costs a few passes over the patches, so more are quicker.
    std::size_t activations = 256;
    /// Shots after which a call returns, as in ProgressiveConfig.
    std::uint64_t max_shots = std::numeric_limits<std::uint64_t>::max();
    ShootingOrder order = ShootingOrder::threshold_scan;  ///< see ShootingOrder
    double sweep_share = 0.25;  ///< of all entries, from which on a batch is a sweep; see ProgressiveConfig
};

/// An incremental solution in which hidden patches with little potential take no part: active patches neither
/// send light to these passive ones nor wait for theirs. For active patches H = F (B − unshot) + H0, the sum
/// over all patches; a passive one keeps the H it has (H0 at the start) and its unshot light until it is
/// activated. Source: Tost and Pueyo 1993, sections 3 and 4.
struct ActivePassiveState : IncrementalState {
    std::vector<std::uint8_t> active;  ///< by patch, 0: passive
    std::vector<double> potential;     ///< by patch, W, when last marked (see potential.h)
    std::vector<std::uint8_t> seen;    ///< the roles' when last marked
    std::vector<Index> queue;          ///< passive patches to activate, the next one last
    std::uint64_t activations = 0;     ///< made so far
};

/// Starts cold and marks what is passive. Errors: as make_progressive_state, and those of the roles.
ActivePassiveState make_active_passive_state(const RadiosityProblem& problem, const PatchRoles& roles,
                                             const ActivePassiveConfig& config,
                                             const Context& context = Context(1));

/// Makes the state stand for another problem of the same patches (see `change` of incremental.h) and marks
/// afresh what is passive. Patches that become active receive what has been shot, as in `activate`; those
/// that become passive keep what they have. Errors as there, and those of the roles.
void change(ActivePassiveState& state, const RadiosityProblem& problem, std::span<const Index> rows,
            const PatchRoles& roles, const ActivePassiveConfig& config, const Context& context);

/// Activates patches at any moment of the solution: *sets* H_i = Σ_j F_ij (B_j − ΔB_j) + H0 over all j,
/// passive or not, and makes ρ_i (H_i new − H_i old) unshot. The report gathers the whole B_j instead; the
/// part of it that is unshot then arrives a second time when j shoots. Patches that are active are left
/// alone.
void activate(ActivePassiveState& state, const RadiosityProblem& problem, std::span<const Index> patches,
              const Context& context);

/// The report's loop: while active patches have light to shoot, they shoot to active patches; else passive
/// patches with most potential are activated, `config.activations` a cycle. Loop on `status`. With
/// Goal::active it is converged when the bound from the active patches' own unshot light is met; with
/// Goal::whole when that of all patches is, and patches to which next to nothing was withheld stay passive.
///
/// The certificate returned is honest in either case: it is of E + ρH over all patches, passive ones as they
/// are. For an active patch |r_i| ≤ g ‖ΔB‖∞ + rounding, where ΔB includes what passive patches keep unshot;
/// for a passive one r_i = ρ_i (F B + H0 − H_i) is gathered, so all light that was withheld from it counts.
/// That costs one pass over the rows of the passive patches a call. With Goal::active it therefore stays
/// large where the hidden are dark in this solution but not in the scene: it says nothing of the picture
/// alone. Same bits for any number of threads and any division into calls. Errors as those of progressive.h.
Certificate step(ActivePassiveState& state, const RadiosityProblem& problem, const FormFactorColumns& columns,
                 const PatchRoles& roles, const ActivePassiveConfig& config, const Context& context);

/// A solution and its promise.
struct ActivePassiveSolution {
    ActivePassiveState state;
    Certificate certificate;
};

/// One call: a cold start and steps until finished (or `config.max_shots`). Errors as above.
ActivePassiveSolution solve_active_passive(const RadiosityProblem& problem, const FormFactorColumns& columns,
                                           const PatchRoles& roles, const ActivePassiveConfig& config,
                                           const Context& context);

}  // namespace afterglow
