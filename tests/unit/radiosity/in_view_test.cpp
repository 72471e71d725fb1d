#include "solver/radiosity/in_view.h"

#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "tests/support/dense_solve.h"
#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::OwnedProblem;

constexpr std::size_t group_count = 8;

/// Every patch in the group of its number.
std::vector<Index> in_runs(std::size_t patches) {
    std::vector<Index> group(patches);
    for (std::size_t i = 0; i < patches; ++i) group[i] = static_cast<Index>(i * group_count / patches);
    return group;
}

std::vector<std::uint8_t> random_view(std::mt19937& random) {
    std::vector<std::uint8_t> seen(group_count);
    for (auto& s : seen) s = random() % 3 == 0 ? 1 : 0;
    seen[random() % group_count] = 1;
    return seen;
}

/// Largest error over what is seen, W/m², against the dense solution.
double error_of(const OwnedProblem& problem, const ProgressiveState& state, const GroupedRows& rows,
                const std::vector<std::uint8_t>& seen) {
    const auto exact = test::solve_radiosity(problem.view());
    double largest = 0;
    for (std::size_t i = 0; i < rows.group.size(); ++i) {
        if (seen[rows.group[i]] == 0) continue;
        for (int c = 0; c < 3; ++c) {
            const double shown = static_cast<double>(problem.emission[i][c]) +
                                 static_cast<double>(problem.reflectance[i][c]) * state.irradiance[i][c];
            largest = std::max(largest, std::abs(shown - exact[i][c]));
        }
    }
    return largest;
}

TEST(InView, TheBoundHoldsAtEveryMomentAndForEveryView) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        const OwnedProblem problem = test::random_problem(seed, 60, test::Closure::closed, .8F);
        const FormFactorColumns columns = problem.columns();
        const GroupedRows rows = group_rows(problem.matrix, in_runs(60), Context(2));
        std::mt19937 random(seed);
        ProgressiveState state = make_progressive_state(problem.view());
        for (int k = 0; k < 6; ++k) {
            const auto seen = random_view(random);
            EXPECT_GE(error_in_view(state, problem.view(), rows, seen, 0, Context(2)),
                      error_of(problem, state, rows, seen))
                << "seed " << seed << ", after " << state.shots;
            ProgressiveConfig config;
            config.max_shots = 1;
            config.sweep_share = 2;
            step(state, problem.view(), columns, config, Context(1));
        }
    }
}

TEST(InView, WhatIsSeenIsAsNearAsAskedWhateverCameIntoViewBefore) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        const OwnedProblem problem = test::random_problem(seed, 60, test::Closure::closed, .8F);
        const FormFactorColumns columns = problem.columns();
        const GroupedRows rows = group_rows(problem.matrix, in_runs(60), Context(2));
        std::mt19937 random(seed);
        IncrementalState state = make_incremental_state(problem.view());
        for (int view = 0; view < 5; ++view) {
            const auto seen = random_view(random);
            const double asked = view % 2 == 0 ? 0.02 : 0.005;
            const Certificate certificate =
                step_in_view(state, problem.view(), columns, rows, seen, {.asked_error = asked}, Context(2));
            EXPECT_EQ(state.status, ProgressiveStatus::converged);
            EXPECT_LE(certificate.error_bound, asked);
            EXPECT_LE(error_of(problem, state, rows, seen),
                      certificate.error_bound * mean_reflected(problem.view(), state.irradiance) + 1e-12);
        }
    }
}

/// Two closed rooms, a few of whose patches see each other.
OwnedProblem two_rooms(double coupling) {
    const OwnedProblem one = test::random_problem(4, 40, test::Closure::closed, .7F);
    std::vector<std::vector<double>> dense(80, std::vector<double>(80, 0.0));
    OwnedProblem both;
    for (std::size_t i = 0; i < 80; ++i) {
        const std::size_t k = i % 40;
        const double kept = k < 4 ? 1 - coupling : 1;
        for (std::uint64_t e = one.matrix.row_begin[k]; e < one.matrix.row_begin[k + 1]; ++e) {
            const std::size_t j = one.matrix.column[e];
            dense[i][j + (i - k)] += kept * static_cast<double>(one.matrix.value[e]);
        }
        if (k < 4) dense[i][(i + 40) % 80] += coupling;
        both.area.push_back(one.area[k]);
        both.emission.push_back(one.emission[k]);
        both.reflectance.push_back(one.reflectance[k]);
    }
    both.matrix = test::matrix_of(dense);
    return both;
}

TEST(InView, LightOfAnotherRoomWaitsUntilThatIsSeen) {
    const OwnedProblem problem = two_rooms(0.02);
    const FormFactorColumns columns = problem.columns();
    const GroupedRows rows = group_rows(problem.matrix, in_runs(80), Context(1));
    const std::vector<std::uint8_t> all(group_count, 1), near{1, 1, 1, 1, 0, 0, 0, 0};
    const auto shots_for = [&](IncrementalState& state, const std::vector<std::uint8_t>& seen) {
        const std::uint64_t before = state.shots;
        step_in_view(state, problem.view(), columns, rows, seen, {.asked_error = .01}, Context(1));
        return state.shots - before;
    };
    IncrementalState whole = make_incremental_state(problem.view());
    const std::uint64_t at_once = shots_for(whole, all);
    IncrementalState state = make_incremental_state(problem.view());
    const std::uint64_t first = shots_for(state, near);
    EXPECT_LT(static_cast<double>(first), 0.8 * static_cast<double>(at_once));
    EXPECT_EQ(shots_for(state, near), 0U);
    const std::uint64_t second = shots_for(state, all);
    EXPECT_GT(second, 0U);
    EXPECT_LT(static_cast<double>(first + second), 1.3 * static_cast<double>(at_once));
}

TEST(InView, GivesTheSameBitsForAnyNumberOfThreads) {
    const OwnedProblem problem = test::random_problem(3, 200, test::Closure::open, .8F);
    const FormFactorColumns columns = problem.columns();
    const std::vector<std::uint8_t> seen{1, 0, 0, 1, 0, 0, 0, 0};
    std::vector<Rgb> one;
    for (const int threads : {1, 2, 4}) {
        const Context context(threads);
        const GroupedRows rows = group_rows(problem.matrix, in_runs(200), context);
        IncrementalState state = make_incremental_state(problem.view());
        step_in_view(state, problem.view(), columns, rows, seen, {}, context);
        if (threads == 1) one = state.irradiance;
        EXPECT_EQ(state.irradiance, one) << threads;
    }
}

TEST(InView, EveryAskedErrorIsMetOrEndsWhereSinglePrecisionDoes) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const OwnedProblem problem = test::random_problem(seed, 60, test::Closure::closed, .8F);
        const GroupedRows rows = group_rows(problem.matrix, in_runs(60), Context(1));
        const std::vector<std::uint8_t> all(group_count, 1);
        for (double asked = 0.3; asked > 1e-10; asked *= 0.3) {
            IncrementalState state = make_incremental_state(problem.view());
            const Certificate certificate =
                step_in_view(state, problem.view(), problem.columns(), rows, all, {asked}, Context(1));
            EXPECT_EQ(state.status == ProgressiveStatus::converged, certificate.error_bound <= asked)
                << asked;
            if (asked > 1e-3) {
                EXPECT_EQ(state.status, ProgressiveStatus::converged) << asked;
            }
            if (asked < 1e-8) {
                EXPECT_EQ(state.status, ProgressiveStatus::exhausted) << asked;
            }
        }
    }
}

TEST(InView, WhatDoesNotFitIsNamed) {
    const OwnedProblem problem = test::random_problem(2, 60, test::Closure::closed, .8F);
    EXPECT_THROW(group_rows(problem.matrix, in_runs(59), Context(1)), Error);
    const GroupedRows rows = group_rows(problem.matrix, in_runs(60), Context(1));
    IncrementalState state = make_incremental_state(problem.view());
    const std::vector<std::uint8_t> short_view(group_count - 1, 1);
    EXPECT_THROW(step_in_view(state, problem.view(), problem.columns(), rows, short_view, {}, Context(1)),
                 Error);
}

TEST(GroupsOfNeighbours, AreOfOneSizeAndApart) {
    std::vector<Vec3> centres;
    for (int x = 0; x < 16; ++x)
        for (int y = 0; y < 4; ++y)
            centres.emplace_back(static_cast<float>(x % 8) + (x < 8 ? 0.0F : 100.0F), static_cast<float>(y),
                                 0);
    const std::vector<Index> group = groups_of_neighbours(centres, 8);
    std::vector<int> count(8, 0), far(8, 0);
    for (std::size_t i = 0; i < group.size(); ++i) {
        ++count[group[i]];
        far[group[i]] += centres[i].x > 50 ? 1 : 0;
    }
    for (std::size_t g = 0; g < 8; ++g) {
        EXPECT_EQ(count[g], 8);
        EXPECT_TRUE(far[g] == 0 || far[g] == 8) << g;
    }
    // No more than there are patches.
    const std::vector<Vec3> three(3, Vec3(1));
    EXPECT_EQ(groups_of_neighbours(three, 8).size(), 3U);
    EXPECT_TRUE(groups_of_neighbours({}, 8).empty());
}

}  // namespace
}  // namespace afterglow
