#include "solver/visibility/group_sight.h"

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using ::testing::ElementsAre;

/// Three boxes on the z axis at 2, 4 and 6 m; the nearest moves away to the side from 1 s to 2 s.
World row_of_boxes() {
    World world = testing::empty_world();
    const Quat straight(1, 0, 0, 0);
    Path leaving;
    leaving.keys = {{1, {Vec3(0, 0, 2), straight}}, {2, {Vec3(5, 0, 2), straight}}};
    Path middle, last;
    middle.keys = {{0, {Vec3(0, 0, 4), straight}}};
    last.keys = {{0, {Vec3(0, 0, 6), straight}}};
    for (const Path& path : {leaving, middle, last}) testing::add_actor(world, "box", Vec3(0.5F), 0, path);
    return world;
}

struct Row {
    World world = row_of_boxes();
    ActorStage stage = make_actor_stage(world, 0.1, 1e-4F);
    ViewGroup group{0, 1, 0xFFFF, {Vec3(-0.1F), Vec3(0.1F)}, {Vec3d(0), 0.2}};
    std::vector<BlockEncounters> encounters{1};

    Row() {
        const auto last = static_cast<std::uint16_t>(stage.times.slices() - 1);
        const auto half = static_cast<std::uint16_t>(last / 2);
        encounters[0].sight = {{0, 0, 0, half}, {0, 2, 0, last}, {5, 2, 0, half}};
    }
    [[nodiscard]] LinePacket straight_ahead() const {
        LinePacket lines;
        lines.rays.count = 2;
        lines.rays.set(0, {Vec3(0), Vec3(0, 0, 1), 10});
        lines.rays.set(1, {Vec3(0.05F, 0, 0), Vec3(0, 0, 1), 1});
        lines.prepare();
        return lines;
    }
};

TEST(GroupSight, KeepsTheActorsThatEverComeBetween) {
    const Row row;
    const GroupSight sight = make_group_sight(row.group, row.stage, row.encounters);
    EXPECT_THAT(sight.actors, ElementsAre(0U, 2U));
    const std::vector<BlockEncounters> none(1);
    EXPECT_TRUE(make_group_sight(row.group, row.stage, none).actors.empty());
}

TEST(GroupSight, TheBackgroundComesLastAndActorsComeAndGo) {
    const Row row;
    GroupSight sight = make_group_sight(row.group, row.stage, row.encounters);
    TemporalGraphWork work;
    update(sight, row.group, row.stage, FaceSearch::tree, 0.5, work);
    EXPECT_THAT(sight.graph.order, ElementsAre(0U, 1U, sight.background()));
    EXPECT_TRUE(sight.present(0));
    EXPECT_TRUE(sight.present(1));
    EXPECT_EQ(sight.trees[0].nodes.size(), row.stage.bodies[0].tree.nodes.size());
    update(sight, row.group, row.stage, FaceSearch::tree, 1.95, work);
    EXPECT_FALSE(sight.present(0));
    EXPECT_TRUE(sight.present(1));
    EXPECT_GT(work.graph_events, 0U);
}

TEST(GroupSight, FollowsLinesFrontToBackUpToTheirEnds) {
    const Row row;
    for (const FaceSearch search : {FaceSearch::all, FaceSearch::order, FaceSearch::tree}) {
        GroupSight sight = make_group_sight(row.group, row.stage, row.encounters);
        TemporalGraphWork work;
        update(sight, row.group, row.stage, search, 0, work);
        const std::vector<Pose> poses = poses_at(row.world, 0);
        std::vector<Box> boxes;
        for (std::size_t b = 1; b < poses.size(); ++b)
            boxes.push_back({poses[b].translation - 0.51F, poses[b].translation + 0.51F});
        const LinePacket lines = row.straight_ahead();
        const PacketQuery query{lines, row.encounters[0].sight, boxes, poses, search};
        LaneHits hits;
        hits.start(lines.rays);
        EXPECT_EQ(follow(sight, row.stage, query, 3, hits, work), 1U);
        EXPECT_EQ(hits.body[0], 1U);
        EXPECT_FLOAT_EQ(hits.distance[0], 1.5F);
        EXPECT_EQ(hits.side[0], Side::front);
        // Without the first box's encounter the last one is met: the middle one never comes between.
        const PacketQuery later{lines, std::span(row.encounters[0].sight).subspan(1, 1), boxes, poses,
                                search};
        hits.start(lines.rays);
        EXPECT_EQ(follow(sight, row.stage, later, 3, hits, work), 1U);
        EXPECT_EQ(hits.body[0], 3U);
        EXPECT_EQ(work.lines_searched, 4U);
    }
}

}  // namespace
}  // namespace afterglow
