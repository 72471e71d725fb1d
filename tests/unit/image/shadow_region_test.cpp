#include "solver/image/shadow_region.h"

#include <random>

#include <gmock/gmock.h>

#include "solver/visibility/spacetime_extent.h"

namespace afterglow {
namespace {

Box random_box(std::mt19937& random, float reach, float largest) {
    std::uniform_real_distribution<float> unit(0, 1);
    const auto any = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    const Vec3 low = reach * (2.0F * any() - 1.0F);
    return {low, low + largest * any()};
}

TEST(ShadowRegion, HoldsThePointsWhoseHullWithTheLightMeetsTheBlocker) {
    std::mt19937 random(1);
    int inside = 0, too_many = 0;
    for (int k = 0; k < 20000; ++k) {
        const Box blocker = random_box(random, 2, 1), light = random_box(random, 2, 1);
        const ShadowRegion region(blocker, light, 1e-5F);
        const Vec3 point = random_box(random, 3, 0).low;
        const bool hides = may_hide(blocker, light, {point, point});
        EXPECT_TRUE(!hides || region.holds(point));
        inside += hides ? 1 : 0;
        too_many += region.holds(point) && !hides ? 1 : 0;
    }
    EXPECT_GT(inside, 500);
    EXPECT_LT(too_many, inside / 100) << "not much more than it must";
}

TEST(ShadowRegion, ABoxMeetsItWhereOneOfItsPointsIsHeld) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0, 1);
    int held = 0;
    for (int k = 0; k < 5000; ++k) {
        const ShadowRegion region(random_box(random, 2, 1), random_box(random, 2, 1), 1e-5F);
        const Box points = random_box(random, 2, 0.5F);
        for (int j = 0; j < 8; ++j) {
            const Vec3 share(unit(random), unit(random), unit(random));
            const bool holds = region.holds(points.low + share * points.extent());
            EXPECT_TRUE(!holds || region.meets(points));
            held += holds ? 1 : 0;
        }
    }
    EXPECT_GT(held, 1000);
}

TEST(ShadowRegion, ALightOverABlockerLeavesTheFloorBesideItAlone) {
    const ShadowRegion region({Vec3(-0.5F, 1, -0.5F), Vec3(0.5F, 2, 0.5F)},
                              {Vec3(-0.1F, 3, -0.1F), Vec3(0.1F, 3, 0.1F)}, 0);
    EXPECT_TRUE(region.holds(Vec3(0)));
    EXPECT_TRUE(region.holds(Vec3(1.2F, 0, 0)));
    EXPECT_FALSE(region.holds(Vec3(2, 0, 0)));
    EXPECT_FALSE(region.holds(Vec3(0, 2.5F, 0))) << "between the blocker and the light";
    EXPECT_FALSE(region.meets({}));
}

TEST(ShadowRegion, WhatTouchesTheLightMayHideItFromEverywhere) {
    const Box box{Vec3(0), Vec3(1)};
    EXPECT_TRUE(ShadowRegion(box, box, 0).holds(Vec3(100)));
}

}  // namespace
}  // namespace afterglow
