#include "solver/radiosity/incremental.h"

#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::Closure;
using test::OwnedProblem;
using testing::ElementsAre;
using testing::IsEmpty;

ProgressiveConfig asking(double error, Finish finish = Finish::bound) {
    ProgressiveConfig config;
    config.asked_error = error;
    config.finish = finish;
    return config;
}

/// A solution of `problem` to follow from.
IncrementalState solved(const OwnedProblem& problem, const ProgressiveConfig& config) {
    IncrementalState state = make_incremental_state(problem.view());
    step(state, problem.view(), problem.columns(), config, Context(1));
    return state;
}

void expect_solved(const IncrementalState& state, const OwnedProblem& problem, const Certificate& certificate,
                   const ProgressiveConfig& config) {
    EXPECT_EQ(state.status, ProgressiveStatus::converged);
    EXPECT_LE(certificate.error_bound, config.asked_error);
    const double scale = mean_reflected(problem.view(), state.irradiance);
    EXPECT_LE(test::largest_error(problem.view(), state.irradiance), certificate.error_bound * scale);
}

TEST(Incremental, FindsChangedRows) {
    const OwnedProblem before = test::random_problem(3, 300, Closure::closed, 0.8F);
    OwnedProblem after = before;
    EXPECT_THAT(changed_rows(before.matrix, after.matrix, Context(1)), IsEmpty());
    after.matrix.value[after.matrix.row_begin[7]] *= 0.5F;
    after.matrix.column[after.matrix.row_begin[290]] ^= 1U;
    after.matrix.column.pop_back();
    after.matrix.value.pop_back();
    --after.matrix.row_begin.back();
    for (const int threads : {1, 2, 4})
        EXPECT_THAT(changed_rows(before.matrix, after.matrix, Context(threads)), ElementsAre(7, 290, 299));
    EXPECT_THROW(changed_rows(before.matrix, test::unit_cube(.5F).matrix, Context(1)), Error);
}

TEST(Incremental, FollowsAnyChangeWithinItsCertificate) {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        const std::size_t patches = 2 + seed % 40;
        const OwnedProblem before = test::random_problem(seed, patches, Closure::closed, 0.9F);
        const OwnedProblem other = test::random_problem(seed + 3000, patches, Closure::open, 0.8F);
        OwnedProblem after = before;
        if (seed & 1U) after.matrix = other.matrix;
        if (seed & 2U) after.emission = other.emission;
        if (seed & 4U) after.reflectance = other.reflectance;
        if (seed & 8U) after.external_irradiance = other.external_irradiance;
        const ProgressiveConfig config = asking(1e-3, seed & 16U ? Finish::sweep : Finish::bound);
        IncrementalState state = solved(before, config);
        change(state, after.view(), changed_rows(before.matrix, after.matrix, Context(1)), Context(1));
        SCOPED_TRACE(seed);
        expect_solved(state, after, step(state, after.view(), after.columns(), config, Context(1)), config);
    }
}

TEST(Incremental, KeepsTheBalanceOfShotAndReceivedLight) {
    // After a change in the middle of a solution: H = F' (B − unshot) + H0' and no light is lost.
    const OwnedProblem before = test::random_problem(9, 50, Closure::open, 0.9F);
    OwnedProblem after = test::random_problem(12, 50, Closure::closed, 0.9F);
    after.area = before.area;
    IncrementalState state = make_incremental_state(before.view());
    ProgressiveConfig config = asking(1e-4);
    config.max_shots = 20;
    step(state, before.view(), before.columns(), config, Context(1));
    change(state, after.view(), changed_rows(before.matrix, after.matrix, Context(1)), Context(1));
    for (std::size_t i = 0; i < 50; ++i) {
        double received = after.view().external(i).r;
        for (std::uint64_t e = after.matrix.row_begin[i]; e < after.matrix.row_begin[i + 1]; ++e) {
            const Index j = after.matrix.column[e];
            const Rgb shot = after.emission[j] + after.reflectance[j] * state.irradiance[j] - state.unshot[j];
            received += static_cast<double>(after.matrix.value[e]) * shot.r;
        }
        EXPECT_NEAR(state.irradiance[i].r, received, 1e-5 * (1 + received)) << "patch " << i;
    }
}

TEST(Incremental, ComesBackFromBlack) {
    OwnedProblem cube = test::unit_cube(0.5F);
    const ProgressiveConfig config = asking(1e-5);
    IncrementalState state = solved(cube, config);
    const FormFactorColumns columns = cube.columns();
    for (const float reflectance : {0.0F, 0.5F}) {
        cube.reflectance.assign(6, Rgb(reflectance));
        change(state, cube.view(), {}, Context(1));
        const Certificate certificate = step(state, cube.view(), columns, config, Context(1));
        expect_solved(state, cube, certificate, config);
    }
    // Closed form 10.
    EXPECT_NEAR(1 + .5 * state.irradiance[0].r, 1.09090909811, 1e-5);
    EXPECT_NEAR(.5 * state.irradiance[1].r, .181745826108, 1e-5);
}

TEST(Incremental, ChangesNothingWhereNothingChanged) {
    const OwnedProblem problem = test::random_problem(6, 40, Closure::closed, 0.8F);
    const ProgressiveConfig config = asking(1e-2);
    const IncrementalState before = solved(problem, config);
    IncrementalState state = before;
    for (int frame = 0; frame < 3; ++frame) {
        change(state, problem.view(), {}, Context(1));
        step(state, problem.view(), problem.columns(), config, Context(1));
    }
    EXPECT_EQ(state.irradiance, before.irradiance);
    EXPECT_EQ(state.unshot, before.unshot);
    EXPECT_EQ(state.shots, before.shots);
    EXPECT_EQ(state.status, ProgressiveStatus::converged);
}

TEST(Incremental, CostsWhatTheChangeCosts) {
    OwnedProblem problem = test::random_problem(6, 400, Closure::closed, 0.6F);
    const ProgressiveConfig config = asking(1e-2);
    IncrementalState state = solved(problem, config);
    const std::uint64_t cold = state.entries;
    // One dim patch begins to shine by 3 % of the mean.
    const double mean = mean_reflected(problem.view(), state.irradiance);
    problem.emission[17] += Rgb(0.03F * static_cast<float>(mean));
    change(state, problem.view(), {}, Context(1));
    step(state, problem.view(), problem.columns(), config, Context(1));
    EXPECT_EQ(state.status, ProgressiveStatus::converged);
    EXPECT_LT(state.entries - cold, cold / 10);
}

TEST(Incremental, IsTheSameForAnyNumberOfThreads) {
    const OwnedProblem before = test::random_problem(12, 700, Closure::closed, 0.9F);
    const OwnedProblem after = test::random_problem(13, 700, Closure::closed, 0.9F);
    const auto follow = [&](int threads) {
        const Context context(threads);
        IncrementalState state = make_incremental_state(before.view(), context);
        step(state, before.view(), columns_of(before.matrix, context), asking(1e-2), context);
        change(state, after.view(), changed_rows(before.matrix, after.matrix, context), context);
        step(state, after.view(), columns_of(after.matrix, context), asking(1e-2), context);
        return state;
    };
    const IncrementalState one = follow(1);
    for (const int threads : {2, 4}) {
        const IncrementalState several = follow(threads);
        EXPECT_EQ(several.irradiance, one.irradiance) << threads << " threads";
        EXPECT_EQ(several.unshot, one.unshot);
        EXPECT_EQ(several.entries, one.entries);
        EXPECT_EQ(several.rounding, one.rounding);
    }
}

TEST(Incremental, ReceivesOnlyWhereItIsActive) {
    const OwnedProblem before = test::random_problem(2, 30, Closure::closed, 0.5F);
    const OwnedProblem after = test::random_problem(4, 30, Closure::closed, 0.9F);
    const ProgressiveConfig config = asking(1e-3);
    IncrementalState state = solved(before, config);
    const std::vector<Rgb> irradiance = state.irradiance;
    std::vector<std::uint8_t> active(30, 1);
    active[3] = active[8] = 0;
    std::vector<Index> all(30);
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_TRUE(change_among(state, after.view(), all, active, Context(1)));
    EXPECT_EQ(state.irradiance[3], irradiance[3]);
    EXPECT_EQ(state.irradiance[8], irradiance[8]);
    EXPECT_NE(state.irradiance[4], irradiance[4]);
    const std::vector<Index> held{3, 8};
    receive(state, after.view(), held, Context(1));
    EXPECT_NE(state.irradiance[3], irradiance[3]);
    const Certificate certificate = step(state, after.view(), after.columns(), config, Context(1));
    expect_solved(state, after, certificate, config);
}

TEST(Incremental, LeavesTheStateAloneOnErrors) {
    OwnedProblem problem = test::random_problem(6, 20, Closure::closed, 0.8F);
    const IncrementalState before = solved(problem, asking(1e-2));
    IncrementalState state = before;
    const std::vector<Index> outside{20};
    EXPECT_THROW(change(state, problem.view(), outside, Context(1)), Error);
    EXPECT_THROW(change(state, test::unit_cube(.5F).view(), {}, Context(1)), Error);
    problem.reflectance[4] = Rgb(1.5F);
    try {
        change(state, problem.view(), {}, Context(1));
        FAIL() << "a gain above 1";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cannot_converge);
    }
    EXPECT_EQ(state.irradiance, before.irradiance);
    EXPECT_EQ(state.reflectance, before.reflectance);
    EXPECT_EQ(state.enclosure.gain, before.enclosure.gain);
}

}  // namespace
}  // namespace afterglow
