#include "solver/radiosity/active_passive.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::Closure;
using test::OwnedProblem;

ActivePassiveConfig asking(double error, Goal goal = Goal::whole) {
    ActivePassiveConfig config;
    config.asked_error = error;
    config.goal = goal;
    config.passive_share = 0.3;
    config.activations = 2;
    return config;
}

void expect_within(const ActivePassiveState& state, const OwnedProblem& problem,
                   const Certificate& certificate) {
    const double scale = mean_reflected(problem.view(), state.irradiance);
    EXPECT_LE(test::largest_error(problem.view(), state.irradiance), certificate.error_bound * scale);
}

TEST(ActivePassive, SolvesTheWholeWithinItsCertificate) {
    std::size_t with_passive = 0;
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        const std::size_t patches = 1 + seed % 50;
        const OwnedProblem problem = test::random_problem(seed, patches, Closure::closed, 0.9F);
        const test::RandomRoles roles(seed, patches);
        const ActivePassiveConfig config = asking(seed % 2 == 0 ? 0.02 : 1e-3);
        const auto start = make_active_passive_state(problem.view(), roles.view(), config);
        with_passive += std::ranges::count(start.active, 0) > 0;
        const auto solution =
            solve_active_passive(problem.view(), problem.columns(), roles.view(), config, Context(1));
        SCOPED_TRACE(seed);
        EXPECT_EQ(solution.state.status, ProgressiveStatus::converged);
        EXPECT_LE(solution.certificate.error_bound, config.asked_error);
        expect_within(solution.state, problem, solution.certificate);
    }
    EXPECT_GT(with_passive, 150U);
}

TEST(ActivePassive, CertificateCountsWhatIsWithheld) {
    int dark = 0;
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        const OwnedProblem problem = test::random_problem(seed, 40, Closure::open, 0.9F);
        const test::RandomRoles roles(seed, 40);
        ActivePassiveConfig config = asking(1e-3, Goal::active);
        const auto solution =
            solve_active_passive(problem.view(), problem.columns(), roles.view(), config, Context(1));
        EXPECT_EQ(solution.state.status, ProgressiveStatus::converged);
        expect_within(solution.state, problem, solution.certificate);
        const double scale = mean_reflected(problem.view(), solution.state.irradiance);
        if (test::largest_error(problem.view(), solution.state.irradiance) <= 1e-3 * scale) continue;
        // Where the hidden are too dark it says so, and the exact residual agrees.
        EXPECT_GT(solution.certificate.error_bound, 1e-3) << seed;
        const Certificate exact = certify(problem.view(), solution.state.irradiance, Context(1));
        EXPECT_LE(exact.residual, solution.certificate.residual * (1 + 1e-5)) << seed;
        ++dark;
    }
    EXPECT_GT(dark, 50);
}

TEST(ActivePassive, HoldsItsCertificateOnTheWay) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        const OwnedProblem problem = test::random_problem(seed, 30, Closure::closed, 0.8F);
        const test::RandomRoles roles(seed, 30);
        ActivePassiveConfig config = asking(1e-3);
        config.max_shots = 1;
        auto state = make_active_passive_state(problem.view(), roles.view(), config);
        while (state.status == ProgressiveStatus::running) {
            const Certificate bound =
                step(state, problem.view(), problem.columns(), roles.view(), config, Context(1));
            if (std::isfinite(bound.error_bound)) expect_within(state, problem, bound);
        }
    }
}

TEST(ActivePassive, PassivePatchesNeitherShootNorReceive) {
    const OwnedProblem problem = test::random_problem(3, 60, Closure::closed, 0.8F);
    const test::RandomRoles roles(3, 60);
    const ActivePassiveConfig config = asking(1e-3, Goal::active);
    const auto start = make_active_passive_state(problem.view(), roles.view(), config);
    const auto solution =
        solve_active_passive(problem.view(), problem.columns(), roles.view(), config, Context(1));
    std::size_t passive = 0;
    for (std::size_t i = 0; i < 60; ++i) {
        if (start.active[i] != 0) continue;
        ++passive;
        EXPECT_EQ(solution.state.irradiance[i], problem.view().external(i));
        EXPECT_EQ(solution.state.unshot[i], start.unshot[i]);
    }
    EXPECT_GT(passive, 3U);
    EXPECT_EQ(solution.state.activations, 0U);
}

TEST(ActivePassive, WithAllActiveIsProgressiveShooting) {
    const OwnedProblem problem = test::random_problem(5, 60, Closure::closed, 0.8F);
    const ActivePassiveConfig config = asking(1e-3, Goal::active);
    const auto solution = solve_active_passive(problem.view(), problem.columns(), {}, config, Context(1));
    ProgressiveConfig progressive;
    progressive.asked_error = config.asked_error;
    progressive.finish = Finish::bound;
    const auto same = solve_progressive(problem.view(), problem.columns(), progressive, Context(1));
    EXPECT_EQ(solution.state.irradiance, same.state.irradiance);
    EXPECT_EQ(solution.state.shots, same.state.shots);
    EXPECT_EQ(solution.certificate.error_bound, same.certificate.error_bound);
}

TEST(ActivePassive, IsTheSameForAnyThreadsAndDivision) {
    const OwnedProblem problem = test::random_problem(12, 600, Closure::closed, 0.9F);
    const test::RandomRoles roles(12, 600);
    const auto solve_with = [&](int threads, std::uint64_t shots) {
        const Context context(threads);
        ActivePassiveConfig config = asking(1e-2);
        config.activations = 30;
        config.max_shots = shots;
        auto state = make_active_passive_state(problem.view(), roles.view(), config, context);
        const FormFactorColumns columns = columns_of(problem.matrix, context);
        int calls = 0;
        while (state.status == ProgressiveStatus::running && ++calls < 10'000)
            step(state, problem.view(), columns, roles.view(), config, context);
        EXPECT_EQ(calls > 1, shots < 1000);
        return state;
    };
    const auto one = solve_with(1, 1'000'000);
    for (const int threads : {1, 2, 4})
        for (const std::uint64_t shots : {0U, 50U, 1'000'000U}) {
            const auto other = solve_with(threads, shots);
            EXPECT_EQ(other.irradiance, one.irradiance) << threads << " threads, " << shots << " shots";
            EXPECT_EQ(other.active, one.active);
            EXPECT_EQ(other.shots, one.shots);
            EXPECT_EQ(other.activations, one.activations);
        }
}

TEST(ActivePassive, FollowsChangesOfSceneAndView) {
    std::mt19937 generator(1);
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        OwnedProblem problem = test::random_problem(seed, 40, Closure::closed, 0.9F);
        const ActivePassiveConfig config = asking(5e-3, seed % 3 == 0 ? Goal::active : Goal::whole);
        test::RandomRoles roles(seed, 40);
        auto state = make_active_passive_state(problem.view(), roles.view(), config);
        step(state, problem.view(), problem.columns(), roles.view(), config, Context(1));
        for (std::uint32_t frame = 1; frame < 6; ++frame) {
            const OwnedProblem before = problem;
            if (frame % 2 == 0) roles = test::RandomRoles(seed + 100 * frame, 40);
            if (frame != 4) {
                const OwnedProblem other = test::random_problem(seed + 9 * frame, 40, Closure::open, 0.9F);
                problem.matrix = other.matrix;
                problem.reflectance[generator() % 40] = Rgb(0.3F);
                problem.emission[generator() % 40] = Rgb(7, 3, 2);
            }
            change(state, problem.view(), changed_rows(before.matrix, problem.matrix, Context(1)),
                   roles.view(), config, Context(1));
            const Certificate bound =
                step(state, problem.view(), problem.columns(), roles.view(), config, Context(1));
            SCOPED_TRACE(seed);
            EXPECT_EQ(state.status, ProgressiveStatus::converged);
            if (config.goal == Goal::whole) {
                EXPECT_LE(bound.error_bound, config.asked_error);
            }
            expect_within(state, problem, bound);
        }
    }
}

TEST(ActivePassive, ChangesNothingWhereNothingChanged) {
    const OwnedProblem problem = test::random_problem(6, 40, Closure::closed, 0.8F);
    const test::RandomRoles roles(6, 40);
    for (const Goal goal : {Goal::whole, Goal::active}) {
        const ActivePassiveConfig config = asking(1e-2, goal);
        const auto before =
            solve_active_passive(problem.view(), problem.columns(), roles.view(), config, Context(1));
        auto state = before.state;
        change(state, problem.view(), {}, roles.view(), config, Context(1));
        const Certificate bound =
            step(state, problem.view(), problem.columns(), roles.view(), config, Context(1));
        EXPECT_EQ(state.irradiance, before.state.irradiance);
        EXPECT_EQ(state.active, before.state.active);
        EXPECT_EQ(bound.error_bound, before.certificate.error_bound);
    }
}

TEST(ActivePassive, RejectsWhatItCannotUse) {
    const OwnedProblem cube = test::unit_cube(0.5F);
    const auto place_of = [&](const ActivePassiveConfig& config, const PatchRoles& roles) {
        try {
            solve_active_passive(cube.view(), cube.columns(), roles, config, Context(1));
        } catch (const Error& error) {
            return error.place();
        }
        return std::string("none");
    };
    ActivePassiveConfig config;
    const std::vector<std::uint8_t> seen(5, 1);
    EXPECT_EQ(place_of(config, {seen, {}, {}, {}}), "seen patches");
    config.asked_error = 0;
    EXPECT_EQ(place_of(config, {}), "asked error");
    config = {};
    config.passive_share = 1.5;
    EXPECT_EQ(place_of(config, {}), "passive share");
    config = {};
    config.activations = 0;
    EXPECT_EQ(place_of(config, {}), "activations");
}

}  // namespace
}  // namespace afterglow
