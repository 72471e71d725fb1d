#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/base/context.h"
#include "solver/radiosity/certificate.h"
#include "solver/radiosity/incremental.h"
#include "solver/radiosity/problem.h"

namespace afterglow {

/// Patches in groups, and how much of what each patch sees is each group: what an error there can do here.
/// Follows from the rows alone, so it is made once for all views of a scene.
struct GroupedRows {
    std::vector<Index> group;  ///< by patch, below `groups`
    std::size_t groups = 0;
    std::vector<float> share;  ///< [patch × groups + group]: Σ F over the group's patches
};

/// Sums the rows. `group`: by patch, numbered from 0 without gaps; few groups (a hundred) cost little, and
/// those that are compact tell near from far. Same bits for any number of threads. Errors: invalid_input
/// where sizes do not agree; cancelled.
GroupedRows group_rows(const FormFactorMatrix& matrix, std::vector<Index> group, const Context& context);

/// Groups of patches that lie near each other: all patches, halved across the longest side of the box around
/// their centres until there are `groups`, or one a patch. By patch. Thread-safety: pure.
std::vector<Index> groups_of_neighbours(std::span<const Vec3> centres, std::size_t groups);

/// Upper bound of |B − B̂| over the groups marked in `seen` (one value a group), W/m², B̂ = E + ρH the state's.
/// With ΔB unshot, an error obeys |e| ≤ ρF (|e| + |ΔB|) + rounding. The first two bounces of |ΔB| are
/// followed patch by patch, a pass over all rows each. The rest begins at most at its largest value / (1 −
/// g), which is all that a certificate of everything can say; with the largest |e| of each group for that of
/// its patches, every further pass gives a smaller bound. Stops where it is `enough` or hardly falls.
double error_in_view(const ProgressiveState& state, const RadiosityProblem& problem, const GroupedRows& rows,
                     std::span<const std::uint8_t> seen, double enough, const Context& context);

/// How far to solve for what is seen.
struct InViewConfig {
    double asked_error = 0.02;  ///< of patches in view, relative to mean_reflected, above 0
    /// As ProgressiveConfig::batch_share, among the patches that keep more unshot light than they may.
    double batch_share = 0.5;
};

/// Shoots until no patch of a seen group is further off than asked. A patch does not shoot while its unshot
/// light does too little to what is seen; of the others those with most power go first. All patches receive:
/// H = F (B − ΔB) + H0 holds everywhere as in any shooting solution, so what waits for another view is unshot
/// light, to be sent out when that comes, and nothing is lost or repeated. `rows` must have been made for
/// this problem. Returns the certificate of what is seen alone. The state is then converged, or exhausted
/// where rounding forbids more. Same bits for any number of threads. Source: the walkthroughs that Tost and
/// Pueyo 1993, section 5, leave to the future; what light does to the view is the importance of Smits, Arvo
/// and Salesin 1992, by groups. Errors: invalid_input; cancelled leaves a consistent state.
Certificate step_in_view(IncrementalState& state, const RadiosityProblem& problem,
                         const FormFactorColumns& columns, const GroupedRows& rows,
                         std::span<const std::uint8_t> seen, const InViewConfig& config,
                         const Context& context);

}  // namespace afterglow
