#include "solver/visibility/encounters.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/support/actors.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

TEST(Encounters, HoldEveryLineThatAnActorEverHides) {
    testing::LinedWorld lined(testing::random_world(9, 4, testing::Movements::turning), 0.5F, 16);
    StaticLines background = make_static_lines(lined.mesh, lined.sight, lined.light);
    extend_static_lines(background, lined.mesh, lined.sight, lined.light, lined.caster, 16, Context(1));
    std::vector<Path> paths;
    for (const Body& body : lined.world.bodies) paths.push_back(body.path);
    const TimeTree times = make_time_tree(paths, 0.2);
    std::vector<SpacetimeExtent> actors;
    for (std::size_t b = 1; b < lined.world.bodies.size(); ++b) {
        Box box;
        for (const Vec3& p : lined.world.bodies[b].positions) box.add(p);
        actors.push_back(swept_extent(box, paths[b], times, 2 * lined.sight.lift_m()));
    }
    const std::size_t blocks = lined.sight.static_blocks();
    std::vector<BlockEncounters> encounters(blocks);
    std::size_t kept = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
        for (const DirectionRange part : {DirectionRange{0, 7}, DirectionRange{7, 16}})
            find_encounters(lined.sight, b, background.background, part, actors, times, encounters[b].sight);
        find_light_encounters(lined.light, lined.sight, lined.mesh, b, lined.caster,
                              background.light_contribution, actors, times, encounters[b].light);
        EXPECT_TRUE(
            std::is_sorted(encounters[b].sight.begin(), encounters[b].sight.end(),
                           [](const Encounter& x, const Encounter& y) { return x.direction < y.direction; }));
        kept += encounters[b].sight.size();
    }
    EXPECT_LT(kept, blocks * 16 * actors.size() * 3 / 4);

    std::size_t hidden = 0;
    RayPacket rays;
    for (const double time : {-1.0, 0.0, 0.1, 0.7, 1.3, 2.0, 2.9, 4.0, 5.0}) {
        lined.caster.set_poses(poses_at(lined.world, time));
        const auto held = [&](const std::vector<Encounter>& list, Index direction, Index actor) {
            return std::any_of(list.begin(), list.end(), [&](const Encounter& e) {
                return e.direction == direction && e.actor == actor && e.during(times.slice_at(time));
            });
        };
        for (std::size_t b = 0; b < blocks; ++b) {
            const PatchBlock& block = lined.sight.blocks()[b];
            for (Index d = 0; d < 16; ++d) {
                lined.sight.rays(b, d, Pose{}, rays);
                for (Index lane = 0; lane < block.count; ++lane) {
                    Ray ray = rays.ray(lane);
                    ray.far = background.background.distance[lined.sight.line(block, d, lane)];
                    const Hit hit = lined.caster.nearest(ray, Scope::actors);
                    if (hit.body == no_index) continue;
                    ++hidden;
                    ASSERT_TRUE(held(encounters[b].sight, d, hit.body - 1)) << "time " << time;
                }
            }
            std::array<float, 16> contribution;
            for (Index k = 0; k < lined.light.lines_per_patch(); ++k) {
                lined.light.rays(b, k, lined.caster, rays, contribution);
                for (Index lane = 0; lane < block.count; ++lane) {
                    if (background.light_contribution[lined.light.line(block, k, lane)] == 0) continue;
                    const Hit hit = lined.caster.nearest(rays.ray(lane), Scope::actors);
                    if (hit.body == no_index) continue;
                    ASSERT_TRUE(held(encounters[b].light, k, hit.body - 1)) << "time " << time;
                }
            }
        }
    }
    EXPECT_GT(hidden, 500U);
}

}  // namespace
}  // namespace afterglow
