#include "solver/visibility/coarseness.h"

#include <gmock/gmock.h>

#include "solver/visibility/sight_lines.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::add_box;
using testing::empty_world;

/// A room 4 m wide and a block that stands in it, sunk a little into the floor.
struct Furnished {
    World world = empty_world();
    Surfaces surfaces;
    SideMask reached;
    RayCaster caster;

    Furnished() : caster(furnish(world)) {
        surfaces = find_surfaces(world, {.facet_size_m = 0.1F});
        // Light is inside the room and outside the block: the front of everything.
        reached.assign(surfaces.list.size(), {true, false});
    }
    static const World& furnish(World& world) {
        add_box(world.bodies[furniture], Vec3(0), Vec3(4), 0, testing::Facing::inwards);
        add_box(world.bodies[furniture], Vec3(1, -0.1F, 1), Vec3(2, 1, 2), 0);
        return world;
    }
    /// A square piece of the floor.
    [[nodiscard]] bool is_too_coarse(float x, float z, float edge) const {
        PatchShape part;
        part.origin = Vec3(x, 0, z);
        part.edge_u = Vec3(0, 0, edge);
        part.edge_v = Vec3(edge, 0, 0);
        part.normal = Vec3(0, 1, 0);
        part.centre = part.origin + 0.5F * (part.edge_u + part.edge_v);
        return Coarseness(caster, surfaces, reached, lift_for(world), {})(part, furniture, Side::front);
    }
};

TEST(Coarseness, FollowsTheDistanceOfWhatIsSeen) {
    const Furnished room;
    EXPECT_FALSE(room.is_too_coarse(3, 3, 0.2F)) << "in the open";
    EXPECT_TRUE(room.is_too_coarse(0.8F, 1.4F, 0.2F)) << "at the block's side";
    EXPECT_FALSE(room.is_too_coarse(0.8F, 1.4F, 0.02F)) << "as far, but small";
    EXPECT_TRUE(room.is_too_coarse(0, 3, 0.4F)) << "at a wall";
}

TEST(Coarseness, APartlyBuriedPartIsTooCoarse) {
    const Furnished room;
    EXPECT_TRUE(room.is_too_coarse(0.99F, 1.4F, 0.02F)) << "half of it lies in the block";
    EXPECT_FALSE(room.is_too_coarse(1.3F, 1.3F, 0.4F)) << "all of it does: no light, nothing to refine";
}

TEST(Coarseness, GivesTheSameAnswerTwice) {
    const Furnished room;
    for (float x = 0; x < 3.6F; x += 0.17F)
        EXPECT_EQ(room.is_too_coarse(x, 0.5F, 0.3F), room.is_too_coarse(x, 0.5F, 0.3F));
}

}  // namespace
}  // namespace afterglow
