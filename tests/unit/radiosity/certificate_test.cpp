#include "solver/radiosity/certificate.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "solver/radiosity/progressive.h"
#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::Closure;
using test::OwnedProblem;

OwnedProblem random_case(std::uint32_t seed) {
    const float largest_reflectance[] = {0.3F, 0.6F, 0.9F, 0.98F};
    return test::random_problem(seed, 1 + seed * 7 % 60, seed % 2 == 0 ? Closure::closed : Closure::open,
                                largest_reflectance[seed / 2 % 4]);
}

TEST(Certificate, IsNeverViolated) {
    const double asked[] = {0.3, 0.02, 1e-3};
    int finite = 0;
    for (std::uint32_t seed = 0; seed < 1000; ++seed) {
        const OwnedProblem problem = random_case(seed);
        const auto order = seed % 5 == 0 ? ShootingOrder::largest_first : ShootingOrder::threshold_scan;
        const auto solution = test::solve(problem, asked[seed % 3], order);
        ASSERT_EQ(solution.state.status, ProgressiveStatus::converged) << "seed " << seed;
        ASSERT_LE(solution.certificate.error_bound, asked[seed % 3]);
        const double scale = mean_reflected(problem.view(), solution.state.irradiance);
        const double error = test::largest_error(problem.view(), solution.state.irradiance);
        ASSERT_LE(error, solution.certificate.error_bound * scale) << "seed " << seed;
        finite += error > 0;
    }
    // Most cases are no trivial ones.
    EXPECT_GT(finite, 900);
}

TEST(Certificate, HoldsOnTheWayToo) {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const OwnedProblem problem = random_case(seed);
        const FormFactorColumns columns = problem.columns();
        ProgressiveConfig config;
        config.asked_error = 1e-3;
        config.max_shots = 1;
        ProgressiveState state = make_progressive_state(problem.view());
        while (state.status == ProgressiveStatus::running) {
            const Certificate bound = step(state, problem.view(), columns, config, Context(1));
            if (std::isinf(bound.error_bound)) continue;
            const double scale = mean_reflected(problem.view(), state.irradiance);
            ASSERT_LE(test::largest_error(problem.view(), state.irradiance), bound.error_bound * scale)
                << "seed " << seed << " after " << state.shots << " shots";
        }
    }
}

TEST(Certificate, OfAnyIrradianceBoundsItsError) {
    for (std::uint32_t seed = 1; seed < 100; ++seed) {
        const OwnedProblem problem = random_case(seed);
        // Irradiances that nobody solved for.
        const OwnedProblem other =
            test::random_problem(seed + 5000, problem.area.size(), Closure::open, 0.9F);
        const std::vector<Rgb>& irradiance = seed % 2 == 0 ? other.emission : other.reflectance;
        const Certificate certificate = certify(problem.view(), irradiance, Context(1));
        if (std::isinf(certificate.error_bound)) continue;
        const double scale = mean_reflected(problem.view(), irradiance);
        EXPECT_LE(test::largest_error(problem.view(), irradiance), certificate.error_bound * scale) << seed;
    }
}

TEST(Certificate, OfTheStateIsNoSmallerThanItsResidual) {
    // The step bounds the residual by g ‖ΔB‖∞; the gather computes it.
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
        const OwnedProblem problem = random_case(seed);
        const auto solution = test::solve(problem, 0.02);
        const Certificate exact = certify(problem.view(), solution.state.irradiance, Context(2));
        // Both count the same rounding; the sweep's own adds at most as much again.
        const double rounding = 1e-5 * solution.certificate.residual + 1e-6;
        EXPECT_LE(exact.residual, solution.certificate.residual + rounding) << "seed " << seed;
        EXPECT_EQ(exact.gain, solution.certificate.gain);
    }
}

TEST(Certificate, SaysTheResidualOfAKnownCase) {
    // Two facing plates that see each other alone: F = 1, ρ = ½, E = (4, 0), H = (0, 2) assumed.
    // B̂ = (4, 1), so r = (½·1 − 0, ½·4 − 1) = (.5, 1); the mean ρH over the plate that does not emit is 1; g
    // = ½.
    const OwnedProblem plates{
        test::matrix_of({{0, 1}, {1, 0}}), {1, 3}, {Rgb(4), Rgb(0)}, {Rgb(.5F), Rgb(.5F)}, {}};
    const std::vector<Rgb> irradiance{Rgb(0), Rgb(2)};
    const Certificate certificate = certify(plates.view(), irradiance, Context(1));
    EXPECT_NEAR(certificate.residual, 1, 2e-6);
    EXPECT_EQ(certificate.gain, .5);
    EXPECT_NEAR(certificate.error_bound, 2, 4e-6);
}

TEST(Certificate, MeanReflectedLeavesOutLampsUnlessAllElseIsBlack) {
    OwnedProblem plates{
        test::matrix_of({{0, 1}, {1, 0}}), {1, 3}, {Rgb(4), Rgb(0)}, {Rgb(.5F), Rgb(.25F)}, {}};
    const std::vector<Rgb> irradiance{Rgb(100), Rgb(4, 8, 0)};
    EXPECT_DOUBLE_EQ(mean_reflected(plates.view(), irradiance), 2);  // .25 × the green 8
    plates.reflectance[1] = Rgb(0);
    EXPECT_DOUBLE_EQ(mean_reflected(plates.view(), irradiance), 12.5);  // .5 × 100 × 1 m² of 4 m²
    plates.reflectance[0] = Rgb(0);
    EXPECT_DOUBLE_EQ(mean_reflected(plates.view(), irradiance), 0);
}

TEST(Certificate, WithoutReflectedLightIsZeroOrInfinite) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(make_certificate(0, 0.5, 0).error_bound, 0);
    EXPECT_EQ(make_certificate(1, 0.5, 0).error_bound, infinity);
    EXPECT_EQ(make_certificate(1, 1.0, 1).error_bound, infinity);
    EXPECT_EQ(make_certificate(1, 0.5, 2).error_bound, 1);
}

}  // namespace
}  // namespace afterglow
