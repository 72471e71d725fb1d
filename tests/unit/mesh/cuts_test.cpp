#include "solver/mesh/cuts.h"

#include <gmock/gmock.h>

#include "solver/mesh/lift.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::add_box;
using testing::add_quad;
using testing::empty_world;

/// A floor of 4 × 4 m in the plane y = 0 that looks up: surface 0.
World floor_world() {
    World world = empty_world();
    add_quad(world.bodies[furniture], Vec3(0), Vec3(0, 0, 4), Vec3(4, 0, 0), 0);
    return world;
}

std::vector<Cut> cuts_of_floor(const World& world) {
    return find_cuts(world, find_surfaces(world)).of_surface[0];
}

/// A sheet of 1 × 2 m over z = 2, from `bottom` up.
World sheet(float bottom) {
    World world = floor_world();
    add_quad(world.bodies[furniture], Vec3(1, bottom, 2), Vec3(2, 0, 0), Vec3(0, 1, 0), 0);
    return world;
}

void expect_cut_under_the_sheet(const World& world, const std::array<bool, 2>& stands_on) {
    const auto cuts = cuts_of_floor(world);
    ASSERT_FALSE(cuts.empty());
    const float near = 3 * lift_for(world);
    float low = 4, high = 0;
    for (const Cut& cut : cuts) {
        for (const Vec3& end : {cut.from, cut.to}) {
            EXPECT_NEAR(end.z, 2, near);
            EXPECT_NEAR(end.y, 0, near);
            low = std::min(low, end.x);
            high = std::max(high, end.x);
        }
        EXPECT_EQ(cut.stands_on, stands_on);
        EXPECT_GE(cut.kerf_m, lift_for(world)) << "or origins of lines could lie beyond";
        EXPECT_LE(cut.kerf_m, near);
    }
    EXPECT_NEAR(low, 1, near);
    EXPECT_NEAR(high, 3, near);
}

TEST(Cuts, ASheetThatStandsCutsTheSideItStandsOn) {
    expect_cut_under_the_sheet(sheet(0), {true, false});
}
TEST(Cuts, ASheetThatPiercesCutsBothSides) {
    expect_cut_under_the_sheet(sheet(-0.3F), {true, true});
}
TEST(Cuts, ASheetThatHangsFromBelowCutsTheLowerSide) {
    expect_cut_under_the_sheet(sheet(-1), {false, true});
}
TEST(Cuts, WhatEndsLowerThanLinesStartStands) {
    expect_cut_under_the_sheet(sheet(0.99F * lift_for(sheet(0))), {true, false});
}

TEST(Cuts, WhatEndsHigherLeavesTheFloorWhole) {
    EXPECT_TRUE(cuts_of_floor(sheet(3 * lift_for(sheet(0)))).empty());
}

TEST(Cuts, WhatLiesInTheFloorOrTouchesItAtAPointLeavesItWhole) {
    World world = floor_world();
    Body& body = world.bodies[furniture];
    add_quad(body, Vec3(1, 0, 1), Vec3(0, 0, 1), Vec3(1, 0, 0), 1);
    add_quad(body, Vec3(2, 0, 2), Vec3(0.5F, 1, 0), Vec3(-0.5F, 1, 0), 0);
    EXPECT_TRUE(cuts_of_floor(world).empty());
}

TEST(Cuts, ABoxCutsAlongItsFoot) {
    World world = floor_world();
    add_box(world.bodies[furniture], Vec3(1, 0, 1), Vec3(2, 1, 3), 0);
    float length = 0;
    for (const Cut& cut : cuts_of_floor(world)) length += glm::length(cut.to - cut.from);
    EXPECT_NEAR(length, 6, 20 * lift_for(world));
}

TEST(Cuts, ASheetThatLeansKeepsPointsFartherOff) {
    World world = floor_world();
    add_quad(world.bodies[furniture], Vec3(1, 0, 2), Vec3(2, 0, 0), Vec3(0, 1, 3), 0);
    const auto cuts = cuts_of_floor(world);
    ASSERT_FALSE(cuts.empty());
    for (const Cut& cut : cuts)
        EXPECT_GT(cut.kerf_m, 3 * lift_for(world)) << "at the height of a lift, it stands three lifts aside";
}

TEST(Cuts, AreTheSameForAnyNumberOfThreads) {
    const World world = testing::small_room();
    const Surfaces surfaces = find_surfaces(world);
    const Cuts one = find_cuts(world, surfaces), two = find_cuts(world, surfaces, Context(2));
    ASSERT_EQ(one.of_surface.size(), two.of_surface.size());
    std::size_t cuts = 0;
    for (std::size_t s = 0; s < one.of_surface.size(); ++s) {
        ASSERT_EQ(one.of_surface[s].size(), two.of_surface[s].size());
        for (std::size_t k = 0; k < one.of_surface[s].size(); ++k, ++cuts) {
            EXPECT_EQ(one.of_surface[s][k].from, two.of_surface[s][k].from);
            EXPECT_EQ(one.of_surface[s][k].to, two.of_surface[s][k].to);
        }
    }
    EXPECT_GT(cuts, 0U);
}

}  // namespace
}  // namespace afterglow
