#include "solver/radiosity/potential.h"

#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::OwnedProblem;
using testing::Each;
using testing::ElementsAre;

TEST(Potential, IsUnshotAndReflectedPowerWhereAllIsSeen) {
    // h = (1/6) / (1 − ½) = ⅓; the emitter has 1 + ⅙, all others ½ · ⅓.
    const OwnedProblem cube = test::unit_cube(0.5F);
    const auto power = potential(cube.view(), cube.emission, {}, Context(1));
    EXPECT_NEAR(power[0], 1 + 1.0 / 6, 1e-6);
    for (std::size_t i = 1; i < 6; ++i) EXPECT_NEAR(power[i], 1.0 / 6, 1e-6);
}

TEST(Potential, OfHiddenPatchesCountsWhatTheyShowTheSeen) {
    const OwnedProblem cube = test::unit_cube(0.5F);
    const std::vector<std::uint8_t> seen{0, 1, 1, 0, 0, 0};
    const auto power = potential(cube.view(), cube.emission, {seen, {}, {}, {}}, Context(2));
    const double face_on = .199824895698 + .200043776075;  // patch 0 faces 1 and has an edge with 2
    EXPECT_NEAR(power[0], (1 + 1.0 / 6) * (face_on + (1 - face_on) * .5 / 3), 1e-6);
    EXPECT_NEAR(power[1], 1.0 / 6, 1e-6);
    const double side = face_on;  // patch 3 faces 2 and has an edge with 1
    EXPECT_NEAR(power[3], (side + (1 - side) * .5 / 3) / 6, 1e-6);
}

TEST(Potential, LightTakenAwayCountsAsMuch) {
    const OwnedProblem cube = test::unit_cube(0.5F);
    std::vector<Rgb> negative = cube.emission;
    for (Rgb& b : negative) b = -b;
    EXPECT_EQ(potential(cube.view(), negative, {}, Context(1)),
              potential(cube.view(), cube.emission, {}, Context(1)));
}

TEST(MarkActive, KeepsAllWhereNothingIsKnownToBeHidden) {
    const std::vector<double> power(5, 0.0);
    EXPECT_THAT(mark_active(power, {}, 1), Each(1));
    const std::vector<std::uint8_t> seen(5, 1);
    EXPECT_THAT(mark_active(power, {seen, {}, {}, {}}, 1), Each(1));
}

TEST(MarkActive, CullsHiddenGroupsWithTheLeastPotential) {
    // Objects: 0 visible with a hidden dark back (patch 1), 1 hidden and dark, 2 a hidden computer whose
    // screen shines (patch 5), 3 hidden and bright. As in the report's figure 6.
    const std::vector<std::uint8_t> seen{1, 0, 0, 0, 0, 0, 0};
    const std::vector<Index> object{0, 0, 1, 1, 2, 2, 3};
    const std::vector<Index> surface{0, 1, 2, 2, 3, 4, 5};
    const std::vector<double> power{50, .2, .1, .3, .2, 30, 40};
    const PatchRoles roles{seen, {}, object, surface};
    EXPECT_THAT(mark_active(power, roles, 0.02), ElementsAre(1, 0, 0, 0, 0, 1, 1));
    EXPECT_THAT(mark_active(power, roles, 0), Each(1));
    EXPECT_THAT(mark_active(power, roles, 1), ElementsAre(1, 0, 0, 0, 0, 0, 0));
}

TEST(MarkActive, LeavesGroupsWithASeenPatchWhole) {
    const std::vector<std::uint8_t> seen{1, 0, 0, 0};
    const std::vector<Index> numbers{0, 0, 1, 1};
    const std::vector<double> power{1, 0, 0, 0};
    EXPECT_THAT(mark_active(power, {seen, {}, numbers, numbers}, 0.1), ElementsAre(1, 1, 0, 0));
    EXPECT_THAT(mark_active(power, {seen, {}, {}, {}}, 0.1), ElementsAre(1, 0, 0, 0));
}

TEST(MarkActive, NeverGivesUpMoreThanItMay) {
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
        const OwnedProblem problem = test::random_problem(seed, 60, test::Closure::closed, 0.9F);
        const test::RandomRoles roles(seed, 60);
        const auto power = potential(problem.view(), problem.emission, roles.view(), Context(1));
        const double whole = std::accumulate(power.begin(), power.end(), 0.0);
        std::size_t fewest = 0;
        for (const double share : {0.0, 0.01, 0.1, 0.5, 1.0}) {
            const auto active = mark_active(power, roles.view(), share);
            double given_up = 0;
            std::size_t passive = 0;
            for (std::size_t i = 0; i < 60; ++i) {
                if (active[i] != 0) continue;
                EXPECT_EQ(roles.seen[i], 0);
                given_up += power[i];
                ++passive;
            }
            EXPECT_LE(given_up, share * whole * (1 + 1e-12));
            EXPECT_GE(passive, fewest);
            fewest = passive;
        }
    }
}

}  // namespace
}  // namespace afterglow
