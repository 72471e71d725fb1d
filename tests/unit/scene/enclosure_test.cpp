#include "solver/scene/enclosure.h"

#include <random>

#include <gmock/gmock.h>

#include "solver/scene/world.h"
#include "tests/unit/scene/test_scenes.h"

namespace afterglow {
namespace {

TEST(IsEnclosed, HoldsEverywhereInsideABoxAndNowhereOutside) {
    const World closed = assemble(room_scene());
    const World open = assemble(open_scene());
    std::mt19937 random(7);
    std::uniform_real_distribution<float> inside(-0.95F, 0.95F);
    for (int k = 0; k < 200; ++k) {
        const Vec3 p(inside(random), inside(random), inside(random));
        EXPECT_TRUE(is_enclosed(closed, p));
        EXPECT_FALSE(is_enclosed(open, p));
        EXPECT_FALSE(is_enclosed(closed, p + Vec3(3, 0, 0)));
    }
}

TEST(IsEnclosed, CountsActorsWhereTheyStartOut) {
    Scene scene = open_scene();
    Mesh door;
    door.positions = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
    door.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
    scene.meshes.push_back(door);
    Node node;
    node.mesh = 1;
    scene.nodes.push_back(node);
    scene.tracks.node_translation.push_back({2, {{0, Vec3(0, 0, -1)}, {1, Vec3(3, 0, -1)}}});
    EXPECT_TRUE(is_enclosed(assemble(scene), Vec3(0)));
    scene.tracks.node_translation[0].keys[0].value = Vec3(1, 0, -1);
    EXPECT_FALSE(is_enclosed(assemble(scene), Vec3(0)));
}

TEST(IsEnclosed, IsFalseForNothing) {
    World world;
    world.bodies.resize(1);
    EXPECT_FALSE(is_enclosed(world, Vec3(0)));
}

}  // namespace
}  // namespace afterglow
