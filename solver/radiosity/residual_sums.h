#pragma once

#include "solver/radiosity/residual.h"

namespace afterglow {

// What every row gathers of the radiosity, as a ResidualState keeps it; `step` is made of this.

inline bool is_any(const DoubleLanes& light) {
    return light.v[0] != 0 || light.v[1] != 0 || light.v[2] != 0;
}

inline void add_light(DoubleLanes& sum, float value, const DoubleLanes::Vector& light) {
    sum.v += static_cast<double>(value) * light;
}

/// The sums of rows [first, last) computed afresh. Thread-safety: other rows may be computed meanwhile.
void gather_rows(ResidualState& state, const ResidualProblem& problem, std::size_t first, std::size_t last);

/// Adds to a row's sums what pushes brought it, and computes them afresh where rounding has come to matter.
void add_to_row(ResidualState& state, const ResidualProblem& problem, std::size_t row,
                const DoubleLanes& by_sight, const DoubleLanes& by_light);

/// The sums of all rows in layers computed afresh. Same bits for any number of threads. Errors: cancelled.
void gather_all(ResidualState& state, const ResidualProblem& problem, const Context& context);

/// Likewise of the rows in layers that gather any light which `change` says has changed, by patch and
/// `nowhere`; the others keep every bit.
void gather_reached(ResidualState& state, const ResidualProblem& problem, std::span<const DoubleLanes> change,
                    const Context& context);

/// The sums of the whole rows. Same bits for any number of threads. Errors: cancelled.
void gather_whole(ResidualState& state, const ResidualProblem& problem, const Context& context);

}  // namespace afterglow
