#include "solver/visibility/block_lines.h"

#include <gmock/gmock.h>

#include "tests/support/actors.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

/// A ray made by itself, from what the header of SightLines says of it.
Ray ray_alone(const testing::LinedWorld& lined, std::size_t block, Index direction, Index lane) {
    const PatchBlock& b = lined.sight.blocks()[block];
    const Sample4 sample = lined.sight.sample(block, direction);
    const PatchPoint point = lined.mesh.point_on(b.first + lane, sample[2], sample[3]);
    const Vec3 local = cosine_direction(sample[0], sample[1]);
    const Ray ray{point.position + lined.sight.lift_m() * point.normal, Frame(point.normal).to_world(local)};
    if (b.body == furniture) return ray;
    const Pose& pose = lined.caster.pose(b.body);
    return {pose.point(ray.origin), pose.direction(ray.direction)};
}

TEST(BlockLines, AreTheRaysThatEachPatchWouldMake) {
    std::size_t whole = 0, parts = 0, moving = 0;
    for (const unsigned seed : {1U, 2U, 3U}) {
        testing::LinedWorld lined(testing::random_world(seed, 4, testing::Movements::turning), 0.6F, 8);
        lined.caster.set_poses(poses_at(lined.world, 0.7));
        for (std::size_t b = 0; b < lined.sight.blocks().size(); ++b) {
            const PatchBlock& block = lined.sight.blocks()[b];
            const BlockLines lines(lined.sight, b, lined.caster.pose(block.body));
            for (Index d = 0; d < 8; ++d) {
                RayPacket rays;
                lines.rays(d, rays);
                ASSERT_EQ(rays.count, block.count);
                for (Index lane = 0; lane < block.count; ++lane) {
                    const Ray alone = ray_alone(lined, b, d, lane), ray = rays.ray(lane);
                    // To the bit: strategies that make lines otherwise must see the same.
                    ASSERT_EQ(ray.origin, alone.origin);
                    ASSERT_EQ(ray.direction, alone.direction);
                    ASSERT_EQ(ray.far, alone.far);
                    ++(lined.mesh.is_whole(block.first + lane) ? whole : parts);
                    if (block.body != furniture) ++moving;
                }
            }
        }
    }
    EXPECT_GT(whole, 1000U);
    EXPECT_GT(parts, 100U);
    EXPECT_GT(moving, 1000U);
}

TEST(BlockLines, TracedTogetherSeeWhatEachSeesByItself) {
    for (const unsigned seed : {4U, 5U}) {
        testing::LinedWorld lined(testing::random_world(seed, 3, testing::Movements::straight), 0.5F, 16);
        std::vector<Index> seen(std::size_t{lined.mesh.size()} * 16);
        const LineRange all{0, lined.sight.blocks().size(), 0, 16};
        trace_lines(lined.sight, lined.mesh, lined.caster, Scope::static_geometry, all, {seen, {}},
                    Context(2));
        std::size_t patches = 0;
        for (std::size_t b = 0; b < lined.sight.blocks().size(); ++b) {
            const PatchBlock& block = lined.sight.blocks()[b];
            for (Index d = 0; d < 16; ++d)
                for (Index lane = 0; lane < block.count; ++lane) {
                    const Ray ray = ray_alone(lined, b, d, lane);
                    RayPacket one;
                    one.count = 1;
                    one.set(0, ray);
                    HitPacket hits;
                    lined.caster.nearest(one, Scope::static_geometry, hits);
                    const Index target = seen[lined.sight.line(block, d, lane)];
                    ASSERT_EQ(target, target_of(hits[0], ray, lined.mesh));
                    if (target < lined.mesh.size()) ++patches;
                }
        }
        EXPECT_GT(patches, 1000U);
    }
}

}  // namespace
}  // namespace afterglow
