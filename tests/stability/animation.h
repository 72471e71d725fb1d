#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "tests/unit/radiosity/problems.h"

namespace afterglow::test {

/// A small closed scene in which things can be changed, with what has changed since the last `take_rows`.
class Animation {
  public:
    /// Rows, areas, lamps and reflectances as those of random_problem.
    Animation(std::uint32_t seed, std::size_t patches, float largest_reflectance);

    OwnedProblem problem;

    [[nodiscard]] Index any_patch() { return static_cast<Index>(random() % problem.area.size()); }

    /// Gives a receiver another row, closed and random.
    void look_elsewhere(Index row);
    /// An occluder of the last `occluders` patches stands in the way of some receivers: it takes `share` of
    /// what each of the first `receivers` sees, and gives back what it took before. 0: it has left.
    void occlude(Index receivers, Index occluders, double share);

    /// Rows changed since last asked, in increasing order; makes the matrix anew.
    std::vector<Index> take_rows();

    std::mt19937 random;

  private:
    std::vector<std::vector<double>> open_;  ///< rows without the occluder
    std::vector<std::vector<double>> rows_;
    std::vector<std::uint8_t> changed_;
};

}  // namespace afterglow::test
