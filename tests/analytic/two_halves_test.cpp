#include "solver/formfactor/two_halves.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/solved_world.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::SolvedWorld;

std::vector<Rgb> radiosities(const SolvedWorld& solved) {
    std::vector<Rgb> out;
    for (Index p = 0; p < solved.mesh.size(); ++p) out.push_back(solved.radiosity(p));
    return out;
}

/// Irradiance that does not come straight from the lamps.
std::vector<Rgb> indirect(const SolvedWorld& solved, const std::vector<Rgb>& radiosity) {
    std::vector<Rgb> out(solved.mesh.size(), Rgb(0));
    const FormFactorMatrix& matrix = solved.factors.matrix;
    for (Index p = 0; p < out.size(); ++p)
        for (std::uint64_t k = matrix.row_begin[p]; k < matrix.row_begin[p + 1]; ++k)
            if (solved.lamps.lamp_of_patch[matrix.column[k]] == no_index)
                out[p] += matrix.value[k] * radiosity[matrix.column[k]];
    return out;
}

TEST(TwoHalves, TellTheNoiseOfManySeeds) {
    constexpr int seeds = 16;
    std::vector<glm::dvec3> sum, squares;
    double told = 0;
    std::vector<float> area;
    for (int seed = 1; seed <= seeds; ++seed) {
        testing::SolvedWorldConfig config;
        config.lines = 64;
        config.seed = static_cast<std::uint64_t>(seed);
        SolvedWorld solved(testing::small_room(), config);
        solved.solve(0);
        const auto radiosity = radiosities(solved);
        const auto irradiance = indirect(solved, radiosity);
        const SeenLines seen{solved.visible.patch, 64, solved.visible.light_contribution};
        const auto differences =
            half_differences(solved.sight, solved.lamps, seen, solved.factors, radiosity, Rgb(0), Context(2));
        sum.resize(irradiance.size());
        squares.resize(irradiance.size());
        area = solved.mesh.area_m2;
        for (std::size_t p = 0; p < irradiance.size(); ++p) {
            const glm::dvec3 h(irradiance[p]);
            sum[p] += h;
            squares[p] += h * h;
            told += area[p] * static_cast<double>(glm::dot(differences[p], differences[p])) / seeds;
        }
    }
    double actual = 0;
    for (std::size_t p = 0; p < sum.size(); ++p)
        actual +=
            area[p] * glm::dot(squares[p] - sum[p] * sum[p] / double{seeds}, glm::dvec3(1)) / (seeds - 1);
    const double ratio = std::sqrt(told / actual);
    RecordProperty("told_over_actual", std::to_string(ratio));
    EXPECT_GT(ratio, 0.9) << "too large rather than too small";
    EXPECT_LT(ratio, 2);
}

TEST(TwoHalves, AgreeWhereAllLinesSeeTheSame) {
    World world = testing::small_room();
    world.materials[0] = testing::diffuse("furnace", Rgb(0.5F), Rgb(1));
    world.materials[0].shines = Material::Shines::both;
    world.materials[1] = world.materials[0];
    SolvedWorld solved(std::move(world));
    solved.solve(0);
    const SeenLines seen{solved.visible.patch, solved.config.lines, solved.visible.light_contribution};
    for (const Rgb& difference : half_differences(solved.sight, solved.lamps, seen, solved.factors,
                                                  radiosities(solved), Rgb(0), Context(2)))
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(difference[c], 0, 1e-3);
}

}  // namespace
}  // namespace afterglow
