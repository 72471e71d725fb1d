#include "solver/visibility/ray_caster.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/support/brute_force.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::add_ball;
using testing::nearest_by_brute_force;

struct RandomScene {
    World world;
    std::mt19937 random;

    explicit RandomScene(unsigned seed) : world(testing::small_room()), random(seed) {
        add_ball(world.bodies[furniture], Vec3(3, 0.5F, 4), 0.3F, 2, 0);
        Box room;
        room.add(Vec3(0.3F));
        room.add(Vec3(3.7F, 2.7F, 4.7F));
        for (int k = 0; k < 3; ++k)
            testing::add_actor(world, "actor", Vec3(0.1F, 0.2F, 0.3F), 0,
                               testing::random_path(random, room, 3, testing::Turning::yes));
    }
    Ray ray() {
        std::uniform_real_distribution<float> unit(0, 1);
        const Vec3 origin =
            Vec3(0.1F) + Vec3(unit(random), unit(random), unit(random)) * Vec3(3.8F, 2.8F, 4.8F);
        const Vec3 towards(unit(random) - 0.5F, unit(random) - 0.5F, unit(random) - 0.5F);
        return {origin, glm::normalize(towards + Vec3(1e-4F))};
    }
};

/// Both found the same place; hits within rounding of an edge, or of each other, are ties.
void expect_same(const Hit& hit, const Hit& oracle) {
    if (testing::distance_from_edge(oracle) < 1e-4 && oracle.body != no_index) return;
    ASSERT_EQ(hit.body, oracle.body);
    if (hit.body == no_index) return;
    EXPECT_NEAR(hit.distance, oracle.distance, 1e-4F * (1 + oracle.distance));
    if (std::abs(hit.distance - oracle.distance) > 1e-6F && hit.triangle != oracle.triangle) return;
    EXPECT_EQ(hit.triangle, oracle.triangle);
    EXPECT_EQ(hit.side, oracle.side);
}

class AllScopes : public ::testing::TestWithParam<Scope> {};
INSTANTIATE_TEST_SUITE_P(RayCaster, AllScopes,
                         ::testing::Values(Scope::static_geometry, Scope::actors, Scope::everything));

TEST_P(AllScopes, NearestAgreesWithBruteForceWhileActorsMove) {
    RandomScene scene(11);
    RayCaster caster(scene.world);
    std::size_t hits = 0;
    for (const double time : {0.0, 0.4, 1.7, 3.0}) {
        const auto poses = poses_at(scene.world, time);
        caster.set_poses(poses);
        for (int k = 0; k < 400; ++k) {
            const Ray ray = scene.ray();
            const Hit hit = caster.nearest(ray, GetParam());
            expect_same(hit, nearest_by_brute_force(scene.world, poses, ray, GetParam()));
            hits += hit.body != no_index ? 1U : 0U;
        }
    }
    EXPECT_GT(hits, 50U);
}

TEST_P(AllScopes, PacketsAgreeWithSingleRays) {
    RandomScene scene(12);
    RayCaster caster(scene.world);
    caster.set_poses(poses_at(scene.world, 0.7));
    for (Index count = 1; count <= 16; ++count) {
        RayPacket packet;
        packet.count = count;
        for (Index lane = 0; lane < count; ++lane) {
            Ray ray = scene.ray();
            ray.far = lane % 3 == 0 ? 1.0F : ray.far;
            packet.set(lane, ray);
        }
        HitPacket hits;
        caster.nearest(packet, GetParam(), hits);
        const std::uint32_t occluded = caster.occluded(packet, GetParam());
        for (Index lane = 0; lane < count; ++lane) {
            const Hit single = caster.nearest(packet.ray(lane), GetParam());
            EXPECT_EQ(hits[lane].body, single.body);
            EXPECT_FLOAT_EQ(hits[lane].distance, single.distance);
            EXPECT_EQ(((occluded >> lane) & 1U) != 0, single.body != no_index);
            EXPECT_EQ(caster.occluded(packet.ray(lane), GetParam()), single.body != no_index);
        }
        EXPECT_EQ(occluded >> count, 0U);
    }
}

TEST(RayCaster, AnEmptyWorldHasNothingToHit) {
    const World world = testing::empty_world();
    const RayCaster caster(world);
    EXPECT_EQ(caster.nearest({Vec3(0), Vec3(0, 0, 1)}, Scope::everything).body, no_index);
}

}  // namespace
}  // namespace afterglow
