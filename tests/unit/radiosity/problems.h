#pragma once

#include <cstdint>
#include <vector>

#include "solver/radiosity/certificate.h"
#include "solver/radiosity/progressive.h"

namespace afterglow::test {

/// A radiosity problem that owns its data, to build by hand.
struct OwnedProblem {
    FormFactorMatrix matrix;
    std::vector<float> area;
    std::vector<Rgb> emission;
    std::vector<Rgb> reflectance;
    std::vector<Rgb> external_irradiance;

    [[nodiscard]] RadiosityProblem view() const {
        return {matrix, area, emission, reflectance, external_irradiance};
    }
    [[nodiscard]] FormFactorColumns columns() const { return columns_of(matrix, Context(1)); }
};

/// Rows given densely; zeros are left out.
FormFactorMatrix matrix_of(const std::vector<std::vector<double>>& rows);

/// Unit cube, one patch a face, face 0 emitting 1, face 1 opposite (DESIGN closed forms 1, 2 and 10).
OwnedProblem unit_cube(float reflectance);

/// A closed scene of `patches` unequal patches in which everything emits 1 and reflects the same. Every row
/// sums to 1 up to float rounding.
OwnedProblem furnace(std::size_t patches, float reflectance);

/// How a random problem is closed.
enum class Closure { closed, open };

/// Random sparse rows, areas over a factor of 100, one to a few lamps, some black patches, reflectance up to
/// `largest_reflectance`, external irradiance in every third seed. The same seed gives the same problem.
OwnedProblem random_problem(std::uint32_t seed, std::size_t patches, Closure closure,
                            float largest_reflectance);

/// Random roles that own their data: half the patches seen, a few moving, a handful of objects and surfaces.
class RandomRoles {
  public:
    RandomRoles(std::uint32_t seed, std::size_t patches);
    [[nodiscard]] PatchRoles view() const { return {seen, moving, object, surface}; }

    std::vector<std::uint8_t> seen, moving;
    std::vector<Index> object, surface;
};

/// Largest |B̂ − B| over patches and channels, W/m², with B̂ = E + ρH and B from the dense solve.
double largest_error(const RadiosityProblem& problem, const std::vector<Rgb>& irradiance);

/// A solution made in one call on one thread.
ProgressiveSolution solve(const OwnedProblem& problem, double asked_error,
                          ShootingOrder order = ShootingOrder::threshold_scan);

}  // namespace afterglow::test
