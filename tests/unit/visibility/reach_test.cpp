#include "solver/visibility/reach.h"

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::add_box;
using testing::add_quad;
using testing::empty_world;
using testing::Facing;

std::array<std::size_t, 2> reached_of_body(World& world, Index body) {
    RayCaster caster(world);
    const Surfaces surfaces = find_surfaces(world);
    const SideMask reached = reachable_sides(world, surfaces, caster, {}, Context(2));
    std::array<std::size_t, 2> count{};
    for (std::size_t s = 0; s < surfaces.list.size(); ++s)
        for (std::size_t side = 0; side < 2; ++side)
            if (surfaces.list[s].body == body && reached[s][side]) ++count[side];
    return count;
}

TEST(Reach, TheOutsideOfAClosedRoomAndTheInsideOfABoxAreLeftOut) {
    World world = empty_world(0.5F, Vec3(2, 1, 2));
    add_box(world.bodies[furniture], Vec3(0), Vec3(4, 3, 4), 0, Facing::inwards);
    add_box(world.bodies[furniture], Vec3(1, 1, 1), Vec3(1.5F), 0);
    EXPECT_EQ(reached_of_body(world, furniture), (std::array<std::size_t, 2>{12, 0}));
}

TEST(Reach, ASealedRoomWithoutLightOrCameraIsLeftOut) {
    World world = empty_world(0.5F, Vec3(2, 1, 2));
    add_box(world.bodies[furniture], Vec3(0), Vec3(4, 3, 4), 0, Facing::inwards);
    add_box(world.bodies[furniture], Vec3(10, 0, 0), Vec3(12, 2, 2), 0, Facing::inwards);
    EXPECT_EQ(reached_of_body(world, furniture)[0], 6U);
}

TEST(Reach, ALampInABoxLightsItsInside) {
    World world = empty_world(0.5F, Vec3(2, 1, 2));
    add_box(world.bodies[furniture], Vec3(0), Vec3(4, 3, 4), 0, Facing::inwards);
    add_box(world.bodies[furniture], Vec3(1), Vec3(2), 0);
    add_quad(world.bodies[furniture], Vec3(1.3F, 1.5F, 1.3F), Vec3(0, 0, 0.3F), Vec3(0.3F, 0, 0), 1);
    // The room's six walls, the box's six outsides and the lamp; the box's six insides and the lamp's back.
    EXPECT_EQ(reached_of_body(world, furniture), (std::array<std::size_t, 2>{13, 7}));
}

TEST(Reach, TheSkyLightsOpenScenes) {
    World world = empty_world(0.5F, Vec3(0, 5, 0));
    world.background = Rgb(1);
    add_box(world.bodies[furniture], Vec3(0), Vec3(1), 0);
    EXPECT_EQ(reached_of_body(world, furniture), (std::array<std::size_t, 2>{6, 0}));
}

TEST(Reach, ActorsAreReachedOnTheirOutside) {
    World world = testing::small_room();
    EXPECT_EQ(reached_of_body(world, 1), (std::array<std::size_t, 2>{6, 0}));
}

}  // namespace
}  // namespace afterglow
