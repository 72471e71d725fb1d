#include "solver/visibility/view_groups.h"

#include <gmock/gmock.h>

#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

TEST(ViewGroups, HoldEveryStaticPatchOnceAndTheOriginsOfItsLines) {
    World world = testing::small_room();
    testing::add_ball(world.bodies[furniture], Vec3(3, 1, 2), 0.5F, 2, 0);
    const testing::LinedWorld lined(std::move(world), 0.2F, 16);
    std::vector<std::size_t> sizes;
    for (const Grouping grouping :
         {Grouping::patch, Grouping::block, Grouping::four_blocks, Grouping::surface}) {
        const auto groups = make_view_groups(lined.mesh, lined.sight, grouping);
        sizes.push_back(groups.size());
        std::vector<int> held(lined.mesh.static_size(), 0);
        for (const ViewGroup& group : groups) {
            for (std::size_t b = group.first_block; b < group.last_block; ++b) {
                const PatchBlock& block = lined.sight.blocks()[b];
                RayPacket rays;
                for (Index d = 0; d < lined.sight.lines_per_patch(); ++d) {
                    lined.sight.rays(b, d, Pose{}, rays);
                    for (Index lane = 0; lane < block.count; ++lane) {
                        if (((group.lanes >> lane) & 1U) == 0) continue;
                        if (d == 0) ++held[block.first + lane];
                        const Vec3 from = rays.ray(lane).origin;
                        ASSERT_TRUE(glm::all(glm::greaterThanEqual(from, group.origins.low)));
                        ASSERT_TRUE(glm::all(glm::lessThanEqual(from, group.origins.high)));
                        const Vec3d off = glm::abs(Vec3d(from) - group.viewpoint.offset_m);
                        ASSERT_TRUE(glm::all(glm::lessThanEqual(off, group.viewpoint.half_extent_m + 1e-6)));
                        ASSERT_LE(glm::length(Vec3d(from) - group.viewpoint.offset_m),
                                  group.viewpoint.radius_m + 1e-6);
                    }
                }
            }
        }
        EXPECT_THAT(held, ::testing::Each(1));
    }
    EXPECT_EQ(sizes[0], lined.mesh.static_size());
    EXPECT_EQ(sizes[1], lined.sight.static_blocks());
    EXPECT_LT(sizes[2], sizes[1]);
    EXPECT_LT(sizes[3], sizes[2]);
}

}  // namespace
}  // namespace afterglow
