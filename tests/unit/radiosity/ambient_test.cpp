#include "solver/radiosity/ambient.h"

#include <gtest/gtest.h>

#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::OwnedProblem;

TEST(Ambient, IsTheLightThatIsMissingInAFurnace) {
    for (const float reflectance : {.2F, .5F, .9F}) {
        const OwnedProblem problem = test::furnace(50, reflectance);
        const double exact = 1 / (1 - static_cast<double>(reflectance));
        ProgressiveConfig config;
        config.asked_error = 1e-3;
        config.max_shots = 1;
        // Everything is alike, so from the start and after any sweep nothing but uniform light is missing.
        ProgressiveState state = make_progressive_state(problem.view());
        const FormFactorColumns columns = problem.columns();
        config.sweep_share = 0;
        for (int sweeps = 0; sweeps < 4; ++sweeps) {
            for (const Rgb& h : irradiance_with_ambient(problem.view(), state))
                EXPECT_NEAR(h.g / exact, 1, 1e-5) << "reflectance " << reflectance << ", sweep " << sweeps;
            step(state, problem.view(), columns, config, Context(1));
        }
    }
}

TEST(Ambient, VanishesAsTheLightIsShot) {
    const OwnedProblem problem = test::random_problem(2, 40, test::Closure::closed, 0.8F);
    const ProgressiveState start = make_progressive_state(problem.view());
    const auto solution = test::solve(problem, 1e-3);
    const double at_start = max_channel(ambient_irradiance(problem.view(), start));
    EXPECT_GT(at_start, 0);
    EXPECT_LT(max_channel(ambient_irradiance(problem.view(), solution.state)), 1e-3 * at_start);
}

TEST(Ambient, CountsOnlyTheLightThatDoesNotEscape) {
    // Each plate sees the other with a quarter: the exact irradiance of two plates of B = 1 / (1 − ρ/4) is
    // B/4.
    const OwnedProblem plates{
        test::matrix_of({{0, .25}, {.25, 0}}), {1, 1}, {Rgb(1), Rgb(1)}, {Rgb(.5F), Rgb(.5F)}, {}};
    const ProgressiveState state = make_progressive_state(plates.view());
    EXPECT_NEAR(ambient_irradiance(plates.view(), state).r, .25 / (1 - .125), 1e-6);
}

TEST(Ambient, IsZeroWithoutPatchesAndNeverNegative) {
    EXPECT_EQ(ambient_irradiance(OwnedProblem{}.view(), ProgressiveState{}), Rgb(0));
    const OwnedProblem cube = test::unit_cube(0.5F);
    ProgressiveState state = make_progressive_state(cube.view());
    state.unshot.assign(6, Rgb(-1e-7F));
    EXPECT_EQ(ambient_irradiance(cube.view(), state), Rgb(0));
}

}  // namespace
}  // namespace afterglow
