#include "solver/image/picture_tiles.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/support/actors.h"

namespace afterglow {
namespace {

TEST(PictureTiles, ACutOffTileCounts) {
    const PictureTiles tiles(17, 8);
    EXPECT_EQ(tiles.count(), 10U);
    EXPECT_EQ(tiles.left(9), 16);
    EXPECT_EQ(tiles.top(9), 4);
}

TEST(PictureTiles, EveryRayThatMeetsABodyLiesInACoveredTile) {
    std::size_t hits = 0, covered_tiles = 0;
    for (const unsigned seed : {1U, 2U, 3U}) {
        const World world = testing::random_world(seed, 6, testing::Movements::turning);
        RayCaster caster(world);
        for (const double time : {0.0, 0.7, 1.6, 2.9}) {
            caster.set_poses(poses_at(world, time));
            const CameraView view = view_at(world.cameras.front(), time, 90, 70);
            const PictureTiles tiles(view.width, view.height);
            std::vector<std::vector<Index>> covered(world.bodies.size());
            for (Index b = 1; b < world.bodies.size(); ++b) {
                covered[b] = tiles_covered(view, tiles, world.bodies[b], caster.pose(b));
                covered_tiles += covered[b].size();
            }
            for (int y = 0; y < view.height; ++y) {
                for (int x = 0; x < view.width; ++x) {
                    const Ray ray = view.ray(static_cast<float>(x) + 0.01F, static_cast<float>(y) + 0.99F);
                    const Hit hit = caster.nearest(ray, Scope::actors);
                    if (hit.body == no_index) continue;
                    ++hits;
                    const int edge = PictureTiles::edge;
                    const auto tile = static_cast<Index>(y / edge * tiles.across + x / edge);
                    EXPECT_TRUE(std::binary_search(covered[hit.body].begin(), covered[hit.body].end(), tile));
                }
            }
        }
    }
    EXPECT_GT(hits, 1000U);
    EXPECT_LT(covered_tiles, hits) << "not simply all of them";
}

TEST(PictureTiles, WhatIsBehindTheCameraCoversNothingAndWhatReachesPastItEverything) {
    World world = testing::empty_world();
    const Index actor = testing::add_actor(world, "actor", Vec3(0.5F), 0, {});
    const CameraView view = view_at(world.cameras.front(), 0, 32, 32);
    const PictureTiles tiles(32, 32);
    EXPECT_TRUE(tiles_covered(view, tiles, world.bodies[actor], {Vec3(0, 0, 3)}).empty());
    EXPECT_EQ(tiles_covered(view, tiles, world.bodies[actor], {Vec3(0, 0, 0.2F)}).size(), tiles.count());
    EXPECT_TRUE(tiles_covered(view, tiles, world.bodies[actor], {Vec3(40, 0, -3)}).empty()) << "beside it";
}

}  // namespace
}  // namespace afterglow
