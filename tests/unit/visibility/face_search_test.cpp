#include "solver/visibility/face_search.h"

#include <bit>
#include <random>

#include <gmock/gmock.h>

#include "tests/support/actors.h"
#include "tests/support/brute_force.h"

namespace afterglow {
namespace {

/// An actor of each kind that splits, and lines from a ball around a viewpoint.
struct Searches {
    World world = testing::empty_world();
    SearchedBody body;
    std::mt19937 random;
    std::normal_distribution<float> normal;

    explicit Searches(unsigned seed) : random(seed) {
        Body& actor = world.bodies.emplace_back();
        testing::add_ring(actor, Vec3(0), 1, 0.3F, 0);
        testing::add_ring(actor, Vec3(0.5F, 0, 0.1F), 0.8F, 0.2F, 0);
        testing::add_ball(actor, Vec3(0, 0, 0.5F), 0.6F, 1, 0);
        body = make_searched_body(world, 1);
    }
    Vec3 point() { return {normal(random), normal(random), normal(random)}; }
};

TEST(FaceSearch, AllThreeFindTheNearest) {
    Searches s(5);
    std::size_t lines = 0, met = 0, different = 0;
    SearchWork all, ordered, walked;
    for (int round = 0; round < 300; ++round) {
        const float radius = round % 3 == 0 ? 0.3F : 0.01F;
        const Vec3 centre = 2.0F * s.point();
        LinePacket packet;
        packet.rays.count = 16;
        for (std::size_t k = 0; k < 16; ++k) {
            const Vec3 from = centre + radius * 0.9F * glm::normalize(s.point());
            packet.rays.set(k, {from, glm::normalize(0.5F * s.point() - from), k == 7 ? 1.5F : 100.0F});
        }
        packet.prepare();
        const TemporalBsp temporal =
            make_temporal_bsp(s.body.tree, steady_views(Path{}, Path{}), {Vec3d(centre), radius}, 0);
        std::array<LaneHits, 3> hits;
        for (LaneHits& h : hits) h.start(packet.rays);
        const std::uint32_t lanes = 0xFFF7;
        const std::array found{search_all(s.body, packet.rays, lanes, hits[0], all),
                               search_in_order(s.body, temporal, packet.rays, lanes, hits[1], ordered),
                               search_tree(s.body, temporal, packet, lanes, hits[2], walked)};
        for (std::size_t k = 0; k < 16; ++k) {
            const Hit oracle = testing::nearest_by_brute_force(s.world, poses_at(s.world, 0),
                                                               packet.rays.ray(k), Scope::actors);
            for (std::size_t search = 0; search < 3; ++search) {
                const bool hit = ((found[search] >> k) & 1U) != 0;
                if (k == 3) {
                    EXPECT_FALSE(hit) << "a lane that was not asked for";
                    continue;
                }
                ++lines;
                met += hit ? 1U : 0U;
                ASSERT_EQ(hit, hits[search].body[k] == 1U);
                const bool same = hit == (oracle.body != no_index) &&
                                  (!hit || std::abs(hits[search].distance[k] - oracle.distance) < 1e-4F);
                different += same ? 0U : 1U;
            }
        }
    }
    EXPECT_LE(different, lines / 3000);
    EXPECT_GT(met, lines / 4);
    // What the order is for.
    EXPECT_LT(ordered.line_face_tests, all.line_face_tests * 2);
    EXPECT_LT(walked.line_face_tests, all.line_face_tests / 2);
}

}  // namespace
}  // namespace afterglow
