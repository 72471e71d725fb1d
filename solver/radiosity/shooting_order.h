#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/base/math.h"
#include "solver/radiosity/problem.h"
#include "solver/radiosity/roles.h"

namespace afterglow {

/// Which patches shoot next. Unshot power is |ΔB| A in its largest channel, so that light in a single channel
/// is never left behind, and light that is taken away counts as much as light that comes.
enum class ShootingOrder {
    threshold_scan,  ///< all near the largest unshot power (a factor of two), as one batch in index order
    largest_first,   ///< the largest alone, found by a scan over all patches: Cohen's order, for comparison
    estimated,       ///< as threshold_scan, by Chen's estimate of what reaches the picture: see below
    report,          ///< Tost and Pueyo's: at equal unshot power visible before hidden: see below
};

/// Chooses shooting patches, batch after batch, for one problem and its roles, which must outlive it.
///
/// `estimated`: with Chen's form factors F_ji = A_i / ΣA, what patch i would add to the light that the
/// patches seen by the observer reflect is |ΔB_i| A_i Σ_j ρ_j A_j / ΣA over the seen patches j other than i,
/// per channel. The sum is nearly the same for all i: the estimate weighs channels by how well the picture
/// reflects them (by a hundredth of the best at least, so that no light waits for ever) and puts off large
/// seen patches, which do not light themselves.
///
/// `report`: equal contribution means the same factor of two. Of the patches that threshold_scan would
/// choose those shoot that are seen, move and reflect half or more; if there are none, those that are seen;
/// if there are none, the rest. What a hidden patch with little light does not even receive is the concern of
/// active-passive solutions. Source: Chen 1990, section 4; Tost and Pueyo 1993, section 3.
class ShooterChoice {
  public:
    ShooterChoice(ShootingOrder order, const RadiosityProblem& problem, const PatchRoles& roles);

    /// The next batch in index order, among the patches for which `active` is not 0 (empty: all) and whose
    /// |ΔB| is above `least`, W/m²: those that contribute at least `share` of what the best does. Empty only
    /// where there are none.
    [[nodiscard]] std::vector<Index> next(std::span<const Rgb> unshot, std::span<const std::uint8_t> active,
                                          float least = 0, double share = 0.5) const;

  private:
    /// Of |ΔB|, in W.
    [[nodiscard]] double contribution(Rgb light, std::size_t patch) const;
    [[nodiscard]] int rank(std::size_t patch) const;

    ShootingOrder order_;
    RadiosityProblem problem_;
    PatchRoles roles_;
    Rgb reflected_by_seen_{1};  ///< Σ ρ_j A_j / ΣA over seen patches
    float least_weight_ = 0;    ///< of a channel
    double area_ = 1;           ///< ΣA, m²
};

}  // namespace afterglow
