#include "solver/visibility/coarseness.h"

#include <utility>

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

TEST(Coarseness, FurnitureIsJudgedByActorsWhereTheyPass) {
    World world = empty_world();
    add_box(world.bodies[furniture], Vec3(0), Vec3(4), 0, testing::Facing::inwards);
    Path walk;
    walk.keys = {{0, {Vec3(1, 0.5F, 1), Quat(1, 0, 0, 0)}}, {1, {Vec3(3, 0.5F, 1), Quat(1, 0, 0, 0)}}};
    testing::add_actor(world, "walker", Vec3(0.2F, 0.5F, 0.2F), 0, walk);
    testing::add_actor(world, "post", Vec3(0.2F, 0.5F, 0.2F), 0, {});
    world.bodies.back().path.keys = {{0, {Vec3(1, 0.5F, 3), Quat(1, 0, 0, 0)}}};
    world.duration_s = 1;
    const auto passing = passing_actors(world, 5);
    ASSERT_EQ(passing.size(), 6U) << "the walker at five moments, the post at one";
    EXPECT_EQ(passing[3].pose.translation, Vec3(2.5F, 0.5F, 1));

    const Surfaces surfaces = find_surfaces(world, {.facet_size_m = 0.1F});
    const SideMask reached(surfaces.list.size(), {true, false});
    RayCaster caster(world);
    caster.set_poses(poses_at(world, 0));
    const Coarseness alone(caster, surfaces, reached, lift_for(world), {});
    const Coarseness with_actors(caster, surfaces, reached, lift_for(world), {}, passing);
    const auto floor = [](float x, float z, float edge) {
        PatchShape part;
        part.origin = Vec3(x, 0, z);
        part.edge_u = Vec3(0, 0, edge);
        part.edge_v = Vec3(edge, 0, 0);
        part.normal = Vec3(0, 1, 0);
        part.centre = part.origin + 0.5F * (part.edge_u + part.edge_v);
        return part;
    };
    const auto judge = [&](const Coarseness& test, float x, float z, float edge) {
        return test(floor(x, z, edge), furniture, Side::front);
    };
    // Beside the walker where it ends, beside the post, and half under the walker on its way.
    for (const auto& [x, z] : {std::pair{2.9F, 1.25F}, {1.25F, 2.9F}, {2.2F, 0.9F}}) {
        EXPECT_FALSE(judge(alone, x, z, 0.2F));
        EXPECT_TRUE(judge(with_actors, x, z, 0.2F)) << x << ", " << z;
    }
    EXPECT_FALSE(judge(with_actors, 2.9F, 1.25F, 0.01F)) << "as near, but small";
    EXPECT_FALSE(judge(with_actors, 3.2F, 3.2F, 0.2F)) << "nobody comes here";
    EXPECT_FALSE(judge(with_actors, 2.95F, 0.95F, 0.05F)) << "all under the walker: no light";
}

TEST(Coarseness, GivesTheSameAnswerTwice) {
    const Furnished room;
    for (float x = 0; x < 3.6F; x += 0.17F)
        EXPECT_EQ(room.is_too_coarse(x, 0.5F, 0.3F), room.is_too_coarse(x, 0.5F, 0.3F));
}

}  // namespace
}  // namespace afterglow
