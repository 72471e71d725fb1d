#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "solver/base/context.h"
#include "solver/base/math.h"
#include "solver/formfactor/layered_matrix.h"
#include "solver/radiosity/certificate.h"
#include "solver/radiosity/exchange.h"

namespace afterglow {

/// What is to be solved at one time: B = E + ρ (F B + H0), with F in layers. The spans and the matrix belong
/// to the caller; all have one element a patch, with the ranges of RadiosityProblem.
struct ResidualProblem {
    const LayeredMatrix& matrix;               ///< F as lines show it now
    std::span<const float> area;               ///< A, m²
    std::span<const Rgb> emission;             ///< E, W/m²
    std::span<const Rgb> reflectance;          ///< ρ
    std::span<const Rgb> external_irradiance;  ///< H0, W/m²
};

/// How far and how to solve.
struct ResidualConfig {
    double asked_error = 0.02;  ///< certificate (error_bound) at which the solution is finished, above 0
    /// Patches whose residual exceeds this share of the largest one are pushed together, in (0, 1].
    double push_share = 0.25;
    /// Nothing is pushed whose residual is below this share of what would be good enough, in (0, 1].
    double least_share = 0.8;
    /// Rounds made before what actors cover hears of them and the residual is computed exactly, 1 or more.
    int rounds_between_surveys = 32;
    /// A round whose columns hold at least this share of all entries is made as a sweep: all patches are
    /// pushed, and the rows gather them in parallel.
    double sweep_share = 0.25;
    /// Pushes after which a call returns. The round in hand is completed, and a call makes at least one: what
    /// is computed does not depend on how pushes are divided over calls.
    std::uint64_t max_pushes = std::numeric_limits<std::uint64_t>::max();
};

/// Where the solution stands.
enum class ResidualStatus {
    running,    ///< more pushes would help
    converged,  ///< the certificate is met
    exhausted,  ///< what is left is less than single precision can tell
};

/// A solution that follows its problem: radiosity, and what each row gathers of it. The residual
/// r = E + ρ (F B + H0) − B follows from them row by row, for whatever E, ρ and H0 there are.
struct ResidualState {
    /// B, W/m², by patch, and 0 for LayeredMatrix::nowhere. The fourth lane is solved along with the others:
    /// w = 1 + ρ F w with the largest channel's ρ, which tells how far a residual can get, see `step`.
    std::vector<Lanes> radiosity;
    std::vector<DoubleLanes> by_sight;  ///< Σ of the sight layer times B, by row, unscaled
    std::vector<DoubleLanes> by_light;  ///< likewise of the light layer
    std::vector<DoubleLanes> by_whole;  ///< by whole row, of this moment
    std::vector<Rgb> irradiance;        ///< H, W/m², by patch: what is shown is E + ρH
    std::vector<Lanes> left;            ///< r when a solution was last finished, by patch; none before
    std::uint64_t pushes = 0;           ///< patches whose radiosity was changed, over all rounds
    std::uint64_t rounds = 0;           ///< of them, or sweeps
    std::uint64_t sweeps = 0;
    std::uint64_t entries = 0;  ///< of columns that pushes went along, sweeps apart
    /// How much rounding a row's sums may have gathered since they were computed, relative to them. Where
    /// that comes to matter they are computed afresh; light that nothing reaches keeps every bit.
    std::vector<float> wear;
    ResidualStatus status = ResidualStatus::running;

    /// How the solution at hand gets on. Rounds between surveys, which leave out what actors cover, converge
    /// only where that is little: where they bring too little, fewer are made at once.
    struct Progress {
        int rounds_allowed = std::numeric_limits<int>::max();             ///< between two surveys
        int rounds_made = 0;                                              ///< since the last survey
        double largest_before = std::numeric_limits<double>::infinity();  ///< residual before them
    } progress;

    /// Room to work in that is kept, since it takes longer to get than to use; means nothing between calls.
    struct Workspace {
        std::vector<DoubleLanes> change;      ///< of B, by patch, since the sums were right
        std::vector<std::uint8_t> is_pushed;  ///< by patch: 1 where there is any, else 0
        /// What the sums of the layers are still to receive: in double, as they are, so that they last.
        std::vector<DoubleLanes> by_sight, by_light;
        std::vector<Lanes> residual;            ///< r, W/m², by patch, without what is still to be received
        std::vector<Lanes> of_sight, of_light;  ///< by row: which share of it gets into the residual
        /// Largest channel of |r| with it; 0 where r was left as it is and is still good enough.
        std::vector<float> magnitude;
        std::vector<Index> place_of_whole;  ///< by row: where it stands among the whole ones
    } workspace;
};

/// Starts with what shines by itself, B = E, and nothing reflected.
/// Errors: invalid_input where sizes do not agree; cancelled.
ResidualState make_residual_state(const ResidualProblem& problem, const Context& context);

/// Starts from the radiosity of a similar problem's state, by patch, where it is known; elsewhere as above.
/// The nearer it is, the less is left to push. Errors: likewise.
ResidualState make_residual_state(const ResidualProblem& problem, std::span<const std::optional<Lanes>> known,
                                  const Context& context);

/// Takes over what changed in the layers since the state's sums were right. `problem.matrix` is as `show`
/// left it, in one part of `changes` all of a row. Errors: as make_residual_state; then the state is of no
/// more use.
void follow(ResidualState& state, const ResidualProblem& problem, std::span<const RowChanges> changes,
            const Context& context);

/// Pushes the largest residuals, signed, until the certificate is met, the first time by half, so that what
/// is left then may stay when others' light dims. Later a patch whose residual is as it was left keeps it as
/// long as it is good enough: light that no change reaches keeps every bit. Stops when the certificate is
/// met, only rounding is left, or `config.max_pushes` more were made. E, ρ and H0 may differ from those of
/// the call before. Returns the certificate of E + ρH. The residual of B is computed, not estimated, with the
/// rounding of sums added. B is off by (1 − ρF)⁻¹ r, and what is shown by ρF (1 − ρF)⁻¹ r: at most
/// g ‖r‖∞ / (1 − g), and, since F has no negative entries, at most max ρFw ‖r‖∞ / (1 − δ) for any w ≥ 0 with
/// w ≥ 1 + ρFw − δ, δ < 1. The smaller one is promised; with w, mean reflectances count where g has the
/// largest. Same bits for any number of threads and any division into calls. Source: Southwell's relaxation;
/// Chen 1990, whose ± energy it generalises. Errors: cannot_converge where the gain is 1 or more;
/// invalid_input; cancelled, after which the state is of no more use.
Certificate step(ResidualState& state, const ResidualProblem& problem, const ResidualConfig& config,
                 const Context& context);

}  // namespace afterglow
