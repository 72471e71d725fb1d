#pragma once

#include <ostream>
#include <span>
#include <vector>

#include "solver/radiosity/active_passive.h"
#include "tests/unit/radiosity/problems.h"

namespace afterglow::test {

/// A way to have the light of every frame.
enum class Solving {
    cold,                ///< progressive, from nothing
    incremental_sweeps,  ///< each frame confirmed by a sweep
    incremental_shots,   ///< each frame ended by the counted rounding
    active_passive,      ///< with random roles, until all patches are solved
};

inline constexpr Solving all_solving[] = {Solving::cold, Solving::incremental_sweeps,
                                          Solving::incremental_shots, Solving::active_passive};

/// For the names of parameterised tests.
void PrintTo(Solving solving, std::ostream* out);

/// One of them, led through an animation.
class Follower {
  public:
    Follower(Solving solving, double asked_error, int threads = 1);

    /// Solves the next frame; `rows` are those that differ from the frame before. Reports as test failures a
    /// solution that does not converge or promises less than was asked, unless single
    /// precision cannot give it.
    Certificate follow(const OwnedProblem& problem, std::span<const Index> rows);

    [[nodiscard]] const std::vector<Rgb>& irradiance() const { return state_.irradiance; }
    [[nodiscard]] const ActivePassiveState& state() const { return state_; }

  private:
    void begin(const OwnedProblem& problem);

    Solving solving_;
    double asked_error_;
    Context context_;
    bool begun_ = false;
    // Holds all that any method keeps.
    ActivePassiveState state_;
    RandomRoles roles_;
};

/// Largest |B̂ − B| by the dense solution, relative as certificates are.
double relative_error(const OwnedProblem& problem, const std::vector<Rgb>& irradiance);

/// Expects that a solution is no further from the dense one than its certificate promises.
void expect_kept(const OwnedProblem& problem, const std::vector<Rgb>& irradiance,
                 const Certificate& certificate);

}  // namespace afterglow::test
