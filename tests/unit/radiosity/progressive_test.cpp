#include "solver/radiosity/progressive.h"

#include <cmath>
#include <limits>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::Closure;
using test::OwnedProblem;

double radiosity(const OwnedProblem& problem, const ProgressiveState& state, std::size_t i, int channel = 0) {
    return static_cast<double>(problem.emission[i][channel]) +
           static_cast<double>(problem.reflectance[i][channel]) * state.irradiance[i][channel];
}

// Closed form 10: (reflectance, emitter, opposite, side).
using CubeForm = std::tuple<float, double, double, double>;
class UnitCube : public testing::TestWithParam<std::tuple<CubeForm, ShootingOrder>> {};

TEST_P(UnitCube, MatchesTheClosedForm) {
    const auto& [form, order] = GetParam();
    const auto& [reflectance, emitter, opposite, side] = form;
    const OwnedProblem cube = test::unit_cube(reflectance);
    const auto solution = test::solve(cube, 1e-5, order);
    // Asked for 1e-5 of the mean reflected light, which is below 1: 1e-4 leaves room for float form factors.
    EXPECT_NEAR(radiosity(cube, solution.state, 0), emitter, 1e-4);
    EXPECT_NEAR(radiosity(cube, solution.state, 1), opposite, 1e-4);
    for (std::size_t i = 2; i < 6; ++i) EXPECT_NEAR(radiosity(cube, solution.state, i), side, 1e-4);
    EXPECT_EQ(solution.state.status, ProgressiveStatus::converged);
    EXPECT_LE(solution.certificate.error_bound, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(
    ClosedForm10, UnitCube,
    testing::Combine(testing::Values(CubeForm{.2F, 1.00961538598, .0480445445, .0480850173566},
                                     CubeForm{.5F, 1.09090909811, .181745826108, .181836268946},
                                     CubeForm{.8F, 1.55172415364, .689551070738, .689681193904}),
                     testing::Values(ShootingOrder::threshold_scan, ShootingOrder::largest_first,
                                     ShootingOrder::estimated, ShootingOrder::report)));

class Furnace : public testing::TestWithParam<float> {};

TEST_P(Furnace, IsUniform) {
    const float reflectance = GetParam();
    const OwnedProblem problem = test::furnace(40, reflectance);
    const auto solution = test::solve(problem, 8e-5);
    ASSERT_EQ(solution.state.status, ProgressiveStatus::converged);
    // The reflectance as a float, since 1/(1−ρ) magnifies its rounding.
    const double exact = 1 / (1 - static_cast<double>(reflectance));
    for (std::size_t i = 0; i < 40; ++i)
        EXPECT_NEAR(radiosity(problem, solution.state, i) / exact, 1, 1e-4) << "patch " << i;
}

INSTANTIATE_TEST_SUITE_P(ClosedForm7, Furnace, testing::Values(.5F, .9F, .99F));

TEST(Progressive, AllOrdersAgreeWithinTheirCertificates) {
    for (std::uint32_t seed = 0; seed < 30; ++seed) {
        const OwnedProblem problem = test::random_problem(seed, 5 + seed, Closure::closed, 0.8F);
        const test::RandomRoles roles(seed, problem.area.size());
        ProgressiveConfig config;
        config.asked_error = 1e-3;
        config.roles = roles.view();
        const auto scan = test::solve(problem, 1e-3);
        const double scale = mean_reflected(problem.view(), scan.state.irradiance);
        for (const auto order :
             {ShootingOrder::largest_first, ShootingOrder::estimated, ShootingOrder::report})
            for (const auto finish : {Finish::sweep, Finish::bound}) {
                config.order = order;
                config.finish = finish;
                const auto other = solve_progressive(problem.view(), problem.columns(), config, Context(1));
                EXPECT_EQ(other.state.status, ProgressiveStatus::converged);
                for (std::size_t i = 0; i < problem.area.size(); ++i)
                    for (int c = 0; c < 3; ++c)
                        EXPECT_NEAR(radiosity(problem, scan.state, i, c),
                                    radiosity(problem, other.state, i, c), 2.01e-3 * scale)
                            << "seed " << seed << ", patch " << i;
            }
    }
}

TEST(Progressive, IsTheSameForAnyNumberOfThreads) {
    const OwnedProblem problem = test::random_problem(12, 700, Closure::closed, 0.9F);
    const auto solve_with = [&](int threads) {
        const Context context(threads);
        return solve_progressive(problem.view(), columns_of(problem.matrix, context), {}, context);
    };
    const auto one = solve_with(1);
    EXPECT_GT(one.state.sweeps, 0U);
    for (const int threads : {2, 4}) {
        const auto several = solve_with(threads);
        EXPECT_EQ(several.state.irradiance, one.state.irradiance) << threads << " threads";
        EXPECT_EQ(several.state.unshot, one.state.unshot);
        EXPECT_EQ(several.state.shots, one.state.shots);
        EXPECT_EQ(several.certificate.error_bound, one.certificate.error_bound);
    }
}

TEST(Progressive, IsTheSameHoweverTheShotsAreDivided) {
    const OwnedProblem problem = test::random_problem(3, 60, Closure::open, 0.9F);
    const FormFactorColumns columns = problem.columns();
    for (const auto order : {ShootingOrder::threshold_scan, ShootingOrder::largest_first}) {
        const auto whole = test::solve(problem, 1e-3, order);
        for (const std::uint64_t shots : {0U, 1U, 2U, 7U, 100U}) {
            ProgressiveConfig config;
            config.asked_error = 1e-3;
            config.max_shots = shots;
            config.order = order;
            ProgressiveState state = make_progressive_state(problem.view());
            Certificate certificate;
            int calls = 0;
            while (state.status == ProgressiveStatus::running && ++calls < 100'000)
                certificate = step(state, problem.view(), columns, config, Context(1));
            EXPECT_GT(calls, 1);
            EXPECT_EQ(state.irradiance, whole.state.irradiance) << shots << " shots a call";
            EXPECT_EQ(state.shots, whole.state.shots);
            EXPECT_EQ(certificate.error_bound, whole.certificate.error_bound);
        }
    }
}

TEST(Progressive, KeepsTheBalanceOfShotAndReceivedLight) {
    // Between steps H = F (B − unshot) + H0 for every patch, whatever was shot so far.
    const OwnedProblem problem = test::random_problem(9, 50, Closure::open, 0.9F);
    const RadiosityProblem view = problem.view();
    const FormFactorColumns columns = problem.columns();
    ProgressiveConfig config;
    config.asked_error = 1e-4;
    config.max_shots = 1;
    ProgressiveState state = make_progressive_state(view);
    for (int calls = 0; state.status == ProgressiveStatus::running && calls < 10'000; ++calls) {
        step(state, view, columns, config, Context(1));
        for (std::size_t i = 0; i < view.patches(); ++i) {
            double received = view.external(i).r;
            for (std::uint64_t e = problem.matrix.row_begin[i]; e < problem.matrix.row_begin[i + 1]; ++e) {
                const Index j = problem.matrix.column[e];
                received += problem.matrix.value[e] * (radiosity(problem, state, j) - state.unshot[j].r);
            }
            // A dozen batches, each of which rounds H once and its sums a few times.
            ASSERT_NEAR(state.irradiance[i].r, received, 1e-5 * (1 + received)) << "patch " << i;
        }
    }
    EXPECT_EQ(state.status, ProgressiveStatus::converged);
}

TEST(Progressive, AbsorbsWhatIsEmittedInAClosedScene) {
    // Reciprocal and closed: everything emitted is absorbed, Σ A E = Σ A (1 − ρ) H.
    for (const float reflectance : {.2F, .5F, .8F}) {
        const OwnedProblem cube = test::unit_cube(reflectance);
        const auto solution = test::solve(cube, 1e-5);
        double absorbed = 0;
        for (std::size_t i = 0; i < 6; ++i)
            absorbed += (1 - static_cast<double>(reflectance)) * solution.state.irradiance[i].r;
        EXPECT_NEAR(absorbed, 1, 1e-4);
    }
}

TEST(Progressive, BlackPatchesReceiveAndReflectNothing) {
    OwnedProblem cube = test::unit_cube(0);
    const auto dark = test::solve(cube, 1e-3);
    EXPECT_EQ(dark.state.status, ProgressiveStatus::converged);
    EXPECT_FLOAT_EQ(dark.state.irradiance[1].r, .199824895698F);
    EXPECT_EQ(dark.state.irradiance[0].r, 0.0F);
    EXPECT_EQ(dark.certificate.error_bound, 0.0);

    cube.reflectance[3] = Rgb(0.5F);
    const auto one_bright = test::solve(cube, 1e-3);
    EXPECT_LE(test::largest_error(cube.view(), one_bright.state.irradiance), 1e-3);
    EXPECT_GT(one_bright.state.irradiance[0].r, 0.0F);
}

TEST(Progressive, IsScaleInvariant) {
    const auto solve_scaled = [](float scale) {
        OwnedProblem problem = test::random_problem(4, 30, Closure::closed, 0.8F);
        for (Rgb& e : problem.emission) e *= scale;
        return test::solve(problem, 1e-3).state;
    };
    const ProgressiveState unit = solve_scaled(1);
    for (const float scale : {1e-6F, 1e6F}) {
        const ProgressiveState scaled = solve_scaled(scale);
        EXPECT_EQ(scaled.status, ProgressiveStatus::converged);
        for (std::size_t i = 0; i < unit.irradiance.size(); ++i)
            // 2e-3: the scaled input is rounded, so a batch may fall on the other side of the threshold.
            EXPECT_NEAR(scaled.irradiance[i].g / scale / unit.irradiance[i].g, 1, 2e-3) << scale;
    }
}

TEST(Progressive, AChannelWithoutLightStaysDark) {
    OwnedProblem problem = test::random_problem(5, 30, Closure::closed, 0.8F);
    for (Rgb& e : problem.emission) e = Rgb(0, 0, e.b);
    const auto solution = test::solve(problem, 1e-3);
    EXPECT_EQ(solution.state.status, ProgressiveStatus::converged);
    const double scale = mean_reflected(problem.view(), solution.state.irradiance);
    EXPECT_LE(test::largest_error(problem.view(), solution.state.irradiance), 1e-3 * scale);
    for (const Rgb& h : solution.state.irradiance) {
        EXPECT_EQ(h.r, 0.0F);
        EXPECT_EQ(h.g, 0.0F);
        EXPECT_GT(h.b, 0.0F);
    }
}

TEST(Progressive, WithoutLightReturnsAtOnce) {
    OwnedProblem cube = test::unit_cube(0.9F);
    cube.emission.assign(6, Rgb(0));
    const auto solution = test::solve(cube, 1e-3);
    EXPECT_EQ(solution.state.status, ProgressiveStatus::converged);
    EXPECT_EQ(solution.state.shots, 0U);
    EXPECT_EQ(solution.certificate.error_bound, 0.0);
}

TEST(Progressive, SolvesNoPatchesAndASinglePatch) {
    EXPECT_EQ(test::solve(OwnedProblem{}, 1e-3).state.status, ProgressiveStatus::converged);

    // A lone patch sees nothing; a concave one sees half of itself: B = E / (1 − ρ/2).
    OwnedProblem lone{test::matrix_of({{0}}), {2}, {Rgb(3)}, {Rgb(0.5F)}, {Rgb(1)}};
    EXPECT_EQ(test::solve(lone, 1e-4).state.irradiance[0], Rgb(1));
    OwnedProblem concave{test::matrix_of({{0.5}}), {2}, {Rgb(3)}, {Rgb(0.5F)}, {}};
    const auto solution = test::solve(concave, 1e-4);
    EXPECT_NEAR(radiosity(concave, solution.state, 0), 4, 1e-3);
}

TEST(Progressive, SolvesExternalLightAlone) {
    OwnedProblem cube = test::unit_cube(0.5F);
    cube.emission.assign(6, Rgb(0));
    cube.external_irradiance.assign(6, Rgb(1));
    const auto solution = test::solve(cube, 1e-4);
    // Uniform: H = 1 + ρ H.
    for (const Rgb& h : solution.state.irradiance) EXPECT_NEAR(h.g, 2, 1e-3);
}

TEST(Progressive, SaysThatAGainOfOneCannotConverge) {
    for (const float reflectance : {1.0F, 1.5F}) {
        OwnedProblem problem{test::matrix_of({{0, 1}, {1, 0}}),
                             {1, 1},
                             {Rgb(1), Rgb(0)},
                             std::vector<Rgb>(2, Rgb(0.5F, reflectance, 0.5F)),
                             {}};
        try {
            make_progressive_state(problem.view());
            FAIL() << "reflectance " << reflectance;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::cannot_converge);
        }
    }
}

TEST(Progressive, StopsWhereSinglePrecisionEnds) {
    const OwnedProblem problem = test::random_problem(6, 40, Closure::closed, 0.95F);
    for (const auto order : {ShootingOrder::threshold_scan, ShootingOrder::largest_first}) {
        const auto solution = test::solve(problem, 1e-12, order);
        EXPECT_EQ(solution.state.status, ProgressiveStatus::exhausted);
        EXPECT_GT(solution.certificate.error_bound, 1e-12);
        EXPECT_LT(solution.certificate.error_bound, 1e-4);
    }
}

TEST(Progressive, CanBeStoppedAndReportsItsProgress) {
    const OwnedProblem problem = test::random_problem(8, 50, Closure::closed, 0.9F);
    std::vector<double> fractions;
    std::stop_source source;
    const Context context(1, source.get_token(), [&](const Progress& p) {
        fractions.push_back(p.fraction);
        if (fractions.size() == 3) source.request_stop();
    });
    ProgressiveConfig config;
    config.asked_error = 1e-4;
    ProgressiveState state = make_progressive_state(problem.view());
    try {
        step(state, problem.view(), problem.columns(), config, context);
        FAIL() << "was not stopped";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
    ASSERT_EQ(fractions.size(), 3U);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));

    // Another call goes on as if nothing had happened.
    step(state, problem.view(), problem.columns(), config, Context(1));
    EXPECT_EQ(state.irradiance, test::solve(problem, 1e-4).state.irradiance);
}

TEST(Progressive, RejectsWhatDoesNotBelongTogether) {
    const OwnedProblem problem = test::random_problem(8, 20, Closure::closed, 0.9F);
    const OwnedProblem other = test::random_problem(8, 21, Closure::closed, 0.9F);
    ProgressiveState state = make_progressive_state(problem.view());
    EXPECT_THROW(step(state, other.view(), other.columns(), {}, Context(1)), Error);
    EXPECT_THROW(step(state, problem.view(), other.columns(), {}, Context(1)), Error);
    ProgressiveConfig config;
    config.asked_error = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(step(state, problem.view(), problem.columns(), config, Context(1)), Error);
    config = {};
    config.batch_share = 0;
    EXPECT_THROW(step(state, problem.view(), problem.columns(), config, Context(1)), Error);
}

}  // namespace
}  // namespace afterglow
