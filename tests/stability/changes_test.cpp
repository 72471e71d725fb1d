// Changes that are hard to follow, each by every way to solve.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/stability/animation.h"
#include "tests/stability/follower.h"

namespace afterglow {
namespace {

using test::Animation;
using test::Follower;
using test::OwnedProblem;
using test::Solving;

class Changes : public testing::TestWithParam<Solving> {
  protected:
    /// Solves the frame and holds it against the dense solution.
    static void follow(Follower& follower, const OwnedProblem& problem, std::span<const Index> rows = {}) {
        const Certificate certificate = follower.follow(problem, rows);
        test::expect_kept(problem, follower.irradiance(), certificate);
    }
};

TEST_P(Changes, ReflectanceGoesToZeroAndBack) {
    OwnedProblem cube = test::unit_cube(0.5F);
    Follower follower(GetParam(), 1e-5);
    for (const float reflectance : {.5F, .25F, 0.0F, 0.0F, .25F, .5F}) {
        cube.reflectance.assign(6, Rgb(reflectance));
        follow(follower, cube);
    }
    EXPECT_NEAR(1 + .5 * follower.irradiance()[0].r, 1.09090909811, 1e-5);
    EXPECT_NEAR(.5 * follower.irradiance()[1].r, .181745826108, 1e-5);
    EXPECT_NEAR(.5 * follower.irradiance()[3].r, .181836268946, 1e-5);
}

TEST_P(Changes, ReflectanceGrowsTowardsOne) {
    OwnedProblem furnace = test::furnace(30, .5F);
    Follower follower(GetParam(), 1e-3);
    for (const float reflectance : {.5F, .7F, .9F, .95F, .98F, .99F, .98F, .9F, .5F}) {
        furnace.reflectance.assign(30, Rgb(reflectance));
        follow(follower, furnace);
        const double exact = 1 / (1 - static_cast<double>(reflectance));
        for (const Rgb& h : follower.irradiance())
            ASSERT_NEAR((1 + static_cast<double>(reflectance) * h.g) / exact, 1, 1e-3) << reflectance;
    }
}

TEST_P(Changes, AFurnaceStaysUniformWhateverMoves) {
    // Closed form 7: no row that is closed can change anything.
    Animation animation(8, 40, .5F);
    animation.problem.emission.assign(40, Rgb(1));
    animation.problem.reflectance.assign(40, Rgb(.7F));
    animation.problem.external_irradiance.clear();
    Follower follower(GetParam(), 1e-4);
    for (int frame = 0; frame < 60; ++frame) {
        for (int k = 0; k < frame % 7; ++k) animation.look_elsewhere(animation.any_patch());
        const auto rows = animation.take_rows();
        follow(follower, animation.problem, rows);
        for (const Rgb& h : follower.irradiance())
            ASSERT_NEAR((1 + .7 * h.b) * .3, 1, 1e-4) << "frame " << frame;
    }
}

TEST_P(Changes, ALampGoesOnAndOffEveryFrame) {
    Animation animation(11, 40, .8F);
    const Rgb lamp = animation.problem.emission[0];
    Follower follower(GetParam(), 5e-3);
    for (int frame = 0; frame < 40; ++frame) {
        animation.problem.emission[0] = frame % 2 == 0 ? lamp : Rgb(0);
        follow(follower, animation.problem);
    }
}

TEST_P(Changes, ASceneGoesDarkAndComesBack) {
    Animation animation(11, 40, .9F);
    const std::vector<Rgb> lamps = animation.problem.emission;
    Follower follower(GetParam(), 1e-3);
    for (int turn = 0; turn < 3; ++turn) {
        animation.problem.emission = lamps;
        follow(follower, animation.problem);
        const std::uint64_t sweeps = follower.state().sweeps;
        animation.problem.emission.assign(40, Rgb(0));
        animation.look_elsewhere(3);
        const auto rows = animation.take_rows();
        follow(follower, animation.problem, rows);
        // Dark is dark at once, not after halving what rounding left for ever.
        EXPECT_LE(follower.state().sweeps, sweeps + 1);
        EXPECT_THAT(follower.irradiance(), testing::Each(Rgb(0)));
    }
}

TEST_P(Changes, OneChannelGoesDark) {
    Animation animation(10, 40, .9F);
    const std::vector<Rgb> lamps = animation.problem.emission;
    Follower follower(GetParam(), 1e-3);
    for (int frame = 0; frame < 6; ++frame) {
        animation.problem.emission = lamps;
        if (frame % 2 == 1)
            for (Rgb& e : animation.problem.emission) e.g = 0;
        follow(follower, animation.problem);
        for (const Rgb& h : follower.irradiance())
            if (frame % 2 == 1) {
                ASSERT_EQ(h.g, 0.0F);
            }
    }
}

TEST_P(Changes, LampsSpanTwelveDecades) {
    Animation animation(13, 30, .8F);
    const std::vector<Rgb> lamps = animation.problem.emission;
    Follower follower(GetParam(), 1e-3);
    for (const float scale : {1.0F, 1e-6F, 1e6F, 1.0F, 1e6F, 1e-6F, 1.0F}) {
        for (std::size_t i = 0; i < 30; ++i) animation.problem.emission[i] = scale * lamps[i];
        animation.look_elsewhere(animation.any_patch());
        const auto rows = animation.take_rows();
        follow(follower, animation.problem, rows);
    }
}

TEST_P(Changes, OneBrightAndOneDimRoom) {
    // Six decades between two rooms that do not see each other; the dim one is held to the mean of both.
    const OwnedProblem one = test::random_problem(2, 20, test::Closure::closed, .8F);
    std::vector<std::vector<double>> rows(40, std::vector<double>(40, 0.0));
    OwnedProblem both;
    for (std::size_t i = 0; i < 40; ++i) {
        const std::size_t k = i % 20;
        for (std::uint64_t e = one.matrix.row_begin[k]; e < one.matrix.row_begin[k + 1]; ++e)
            rows[i][one.matrix.column[e] + (i - k)] += static_cast<double>(one.matrix.value[e]);
        both.area.push_back(one.area[k]);
        both.emission.push_back(one.emission[k] * (i < 20 ? 1e3F : 1e-3F));
        both.reflectance.push_back(one.reflectance[k]);
    }
    both.matrix = test::matrix_of(rows);
    Follower follower(GetParam(), 1e-3);
    for (int frame = 0; frame < 10; ++frame) {
        both.emission[static_cast<std::size_t>(frame)] += Rgb(3, 2, 1);
        follow(follower, both);
    }
}

TEST_P(Changes, OnePatchAndNone) {
    OwnedProblem concave{test::matrix_of({{0.5}}), {2}, {Rgb(3)}, {Rgb(0.5F)}, {}};
    Follower follower(GetParam(), 1e-4);
    for (const float emission : {3.0F, 0.0F, 6.0F}) {
        concave.emission[0] = Rgb(emission);
        follow(follower, concave);
        EXPECT_NEAR(emission + .5 * follower.irradiance()[0].g, emission * 4 / 3, 1e-3);
    }
    Follower empty(GetParam(), 1e-4);
    for (int frame = 0; frame < 2; ++frame) follow(empty, OwnedProblem{});
}

INSTANTIATE_TEST_SUITE_P(Stability, Changes, testing::ValuesIn(test::all_solving),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace afterglow
