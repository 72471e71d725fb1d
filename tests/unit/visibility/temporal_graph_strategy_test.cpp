#include "solver/visibility/temporal_graph_strategy.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/support/actors.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::background_of;
using testing::LinedWorld;
using testing::Movements;

constexpr FrameClock clock_of_tests{12};

/// A world, its backgrounds, and what both strategies see of it.
struct Contest {
    LinedWorld lined;
    StaticLines background;
    std::unique_ptr<VisibilityStrategy> retrace = make_retrace();

    explicit Contest(World world, float patch_size_m = 0.4F, Index lines = 16)
        : lined(std::move(world), patch_size_m, lines, 8), background(background_of(lined)) {}

    VisibleLines look(VisibilityStrategy& strategy, int frame, int threads = 2) {
        VisibleLines visible = make_visible_lines(lined.mesh, lined.sight, lined.light);
        lined.caster.set_poses(poses_at(lined.world, clock_of_tests.time_of(frame)));
        strategy.update({lined.mesh, lined.sight, lined.light, lined.caster, background, frame},
                        {0, lined.sight.lines_per_patch()}, visible, Context(threads));
        return visible;
    }
};

/// Lines that see something else, of how many.
struct Differences {
    std::size_t sight = 0, light = 0;
    std::size_t sight_lines = 0, light_lines = 0;
    std::size_t occluded = 0;  ///< static lines that see an actor

    void compare(const VisibleLines& seen, const VisibleLines& expected) {
        for (std::size_t k = 0; k < seen.patch.size(); ++k)
            sight += seen.patch[k] != expected.patch[k] ? 1U : 0U;
        for (std::size_t k = 0; k < seen.light_contribution.size(); ++k)
            light += seen.light_contribution[k] != expected.light_contribution[k] ? 1U : 0U;
        sight_lines += seen.patch.size();
        light_lines += seen.light_contribution.size();
    }
    void expect_ties_only() const {
        EXPECT_LE(sight, sight_lines / 10000) << "of " << sight_lines;
        EXPECT_LE(light, light_lines / 10000) << "of " << light_lines;
    }
    void record() const {
        ::testing::Test::RecordProperty("sight_lines", std::to_string(sight_lines));
        ::testing::Test::RecordProperty("sight_different", std::to_string(sight));
        ::testing::Test::RecordProperty("light_lines", std::to_string(light_lines));
        ::testing::Test::RecordProperty("light_different", std::to_string(light));
        ::testing::Test::RecordProperty("occluded", std::to_string(occluded));
    }
};

/// Frames forwards, with leaps and back again.
const std::vector<int> some_frames{0, 1, 2, 3, 11, 12, 13, 20, 24, 25, 36, 47, 48, 60, 30, 5};

Differences contest(World world, const TemporalGraphConfig& config, const std::vector<int>& frames) {
    Contest c(std::move(world));
    TemporalGraphStrategy strategy(c.lined.world, clock_of_tests, config);
    Differences differences;
    for (const int frame : frames) {
        const VisibleLines expected = c.look(*c.retrace, frame);
        differences.compare(c.look(strategy, frame), expected);
        const std::size_t of_furniture =
            std::size_t{c.lined.mesh.static_size()} * c.lined.sight.lines_per_patch();
        for (std::size_t k = 0; k < of_furniture; ++k)
            differences.occluded += expected.patch[k] != c.background.background.patch[k] ? 1U : 0U;
    }
    return differences;
}

class TemporalGraphStrategyOn : public ::testing::TestWithParam<FaceSearch> {};

TEST_P(TemporalGraphStrategyOn, RandomWorldsSeesWhatRetraceSees) {
    Differences all;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        const Movements movements = seed % 3 == 0 ? Movements::straight : Movements::turning;
        const Differences one = contest(testing::random_world(seed, static_cast<int>(seed), movements),
                                        {.search = GetParam()}, some_frames);
        one.expect_ties_only();
        all.sight += one.sight;
        all.light += one.light;
        all.sight_lines += one.sight_lines;
        all.light_lines += one.light_lines;
        all.occluded += one.occluded;
    }
    all.record();
    // The worlds are worth looking at.
    EXPECT_GT(all.occluded, all.sight_lines / 100);
}

TEST_P(TemporalGraphStrategyOn, CirclesSeesWhatRetraceSees) {
    for (const auto& make : {testing::interlocked_rings, testing::overlapping_bars}) {
        const Differences one = contest(make(), {.search = GetParam()}, {0, 1, 2, 6, 12, 20, 24, 30, 3});
        one.expect_ties_only();
        EXPECT_GT(one.occluded, 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(Searches, TemporalGraphStrategyOn,
                         ::testing::Values(FaceSearch::all, FaceSearch::order, FaceSearch::tree));

class TemporalGraphStrategyBy : public ::testing::TestWithParam<Grouping> {};

TEST_P(TemporalGraphStrategyBy, AnyGroupingSeesWhatRetraceSees) {
    for (const unsigned seed : {21U, 22U})
        contest(testing::random_world(seed, 5, Movements::turning), {.grouping = GetParam()}, some_frames)
            .expect_ties_only();
}

INSTANTIATE_TEST_SUITE_P(Groupings, TemporalGraphStrategyBy,
                         ::testing::Values(Grouping::patch, Grouping::block, Grouping::four_blocks,
                                           Grouping::surface));

TEST(TemporalGraphStrategy, GivesTheSameBitsForAnyThreadsHistoryAndDivision) {
    Contest c(testing::random_world(31, 6, Movements::turning));
    TemporalGraphStrategy first(c.lined.world, clock_of_tests), second(c.lined.world, clock_of_tests);
    for (const int frame : {0, 10, 40}) c.look(first, frame, 1);
    const VisibleLines whole = c.look(first, 17, 2), fresh = c.look(second, 17, 1);
    EXPECT_EQ(whole.patch, fresh.patch);
    EXPECT_EQ(whole.light_contribution, fresh.light_contribution);

    TemporalGraphStrategy third(c.lined.world, clock_of_tests);
    VisibleLines parts = make_visible_lines(c.lined.mesh, c.lined.sight, c.lined.light);
    for (const DirectionRange range : {DirectionRange{0, 5}, DirectionRange{5, 11}, DirectionRange{11, 16}})
        third.update({c.lined.mesh, c.lined.sight, c.lined.light, c.lined.caster, c.background, 17}, range,
                     parts, Context(1));
    EXPECT_EQ(parts.patch, whole.patch);
    EXPECT_EQ(parts.light_contribution, whole.light_contribution);
}

TEST(TemporalGraphStrategy, WhatNoActorCanHideIsDefinitelyValidAndCostsNothing) {
    // The actor stays in a corner behind a wall.
    World world = testing::small_room();
    world.bodies.pop_back();
    Path path;
    path.keys = {{0, {Vec3(-2, 1, 1), Quat(1, 0, 0, 0)}}, {2, {Vec3(-2, 1, 4), Quat(1, 0, 0, 0)}}};
    testing::add_actor(world, "outside", Vec3(0.3F), 0, path);
    Contest c(std::move(world));
    TemporalGraphStrategy strategy(c.lined.world, clock_of_tests);
    const Index room_wall = 0;
    ASSERT_EQ(c.lined.mesh.surfaces.list[room_wall].body, furniture);
    for (const int frame : {0, 9, 18}) {
        const VisibleLines expected = c.look(*c.retrace, frame), seen = c.look(strategy, frame);
        Differences differences;
        differences.compare(seen, expected);
        differences.expect_ties_only();
    }
    // Only the walls' outer sides can see it: at most half of all lines, and fewer are in packets kept.
    const std::uint64_t all = std::uint64_t{c.lined.mesh.static_size()} * c.lined.sight.lines_per_patch();
    EXPECT_GT(strategy.lines_kept(c.lined.sight), 0U);
    EXPECT_LT(strategy.lines_kept(c.lined.sight), all / 8);
    EXPECT_GT(strategy.graphs(), 0U);
    EXPECT_LT(strategy.graphs(), c.lined.sight.static_blocks() / 2);
}

TEST(TemporalGraphStrategy, AnActorAtRestNeedsNoUpdates) {
    World world = testing::small_room();
    Path& path = world.bodies.back().path;
    path.keys.push_back({5, path.keys.back().value});
    Contest c(std::move(world));
    TemporalGraphStrategy strategy(c.lined.world, clock_of_tests);
    c.look(strategy, 47);
    c.look(strategy, 48);
    EXPECT_EQ(strategy.work().graph_events, 0U);
    EXPECT_EQ(strategy.work().tree_visits, 0U);
    EXPECT_GT(strategy.work().search.line_face_tests, 0U);
}

TEST(TemporalGraphStrategy, CoincidentFacesAreTiesAndNothingElse) {
    // Two boxes in one: their sides lie on each other, the second reaches farther along x.
    World world = testing::small_room();
    world.bodies.pop_back();
    Path path;
    path.keys = {{0, {Vec3(1, 1, 3), Quat(1, 0, 0, 0)}}, {2, {Vec3(3, 1.5F, 2), Quat(1, 0, 0, 0)}}};
    const Index actor = testing::add_actor(world, "double", Vec3(0.4F), 0, path);
    testing::add_box(world.bodies[actor], Vec3(-0.1F, -0.4F, -0.4F), Vec3(0.7F, 0.4F, 0.4F), 1);
    for (const FaceSearch search : {FaceSearch::all, FaceSearch::order, FaceSearch::tree}) {
        Contest c(world);
        TemporalGraphStrategy strategy(c.lined.world, clock_of_tests, {.search = search});
        const PatchMesh& mesh = c.lined.mesh;
        std::size_t ties = 0, others = 0;
        for (const int frame : {0, 5, 11, 24}) {
            const VisibleLines expected = c.look(*c.retrace, frame), seen = c.look(strategy, frame);
            for (std::size_t k = 0; k < seen.patch.size(); ++k) {
                const Index a = seen.patch[k], b = expected.patch[k];
                if (a == b) continue;
                const bool one_plane =
                    a < mesh.size() && b < mesh.size() && mesh.body[a] == actor && mesh.body[b] == actor &&
                    std::abs(glm::dot(mesh.normal[a], mesh.normal[b])) > 0.9999F &&
                    std::abs(glm::dot(mesh.normal[a], mesh.centre[a] - mesh.centre[b])) < 1e-5F;
                (one_plane ? ties : others) += 1;
            }
            EXPECT_EQ(seen.light_contribution, expected.light_contribution);
        }
        EXPECT_EQ(others, 0U);
        EXPECT_GT(ties, 0U) << "the world has no ties to tell from";
    }
}

TEST(TemporalGraphStrategy, WorksWithoutActors) {
    World world = testing::small_room();
    world.bodies.pop_back();
    Contest c(std::move(world));
    TemporalGraphStrategy strategy(c.lined.world, clock_of_tests);
    EXPECT_EQ(c.look(strategy, 3).patch, c.look(*c.retrace, 3).patch);
    EXPECT_EQ(strategy.graphs(), 0U);
}

}  // namespace
}  // namespace afterglow
