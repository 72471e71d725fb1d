#include "solver/visibility/tie.h"

#include <algorithm>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "solver/visibility/events.h"
#include "solver/visibility/time_buffer.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::LinedWorld;

constexpr FrameClock clock_of_tests{20};

/// The room with boxes of one height that walk across its floor and through each other: their tops and
/// bottoms share two planes.
World walkers(unsigned seed, int count) {
    World world = testing::small_room();
    world.bodies.resize(1);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> x(0.7F, 3.2F), z(1.2F, 3.6F);
    for (int k = 0; k < count; ++k) {
        Path path;
        for (int key = 0; key < 4; ++key)
            path.keys.push_back(
                {static_cast<double>(key), {Vec3(x(random), 0.8F, z(random)), Quat(1, 0, 0, 0)}});
        testing::add_actor(world, "walker", Vec3(0.3F, 0.75F, 0.25F), 0, path);
    }
    return world;
}

TEST(Tie, TheLowerNumberIsSeen) {
    World world = testing::small_room();
    world.bodies.resize(1);
    const Quat level(1, 0, 0, 0);
    Path left, right;
    left.keys = {{0, {Vec3(1.6F, 0.8F, 2), level}}};
    right.keys = {{0, {Vec3(1.9F, 0.8F, 2), level}}};
    testing::add_actor(world, "left", Vec3(0.3F), 0, left);
    testing::add_actor(world, "right", Vec3(0.3F), 0, right);
    const RayCaster caster(world);
    RayPacket rays;
    HitPacket hits;
    const float places[] = {1.4F, 1.65F, 1.7F, 1.75F, 1.85F, 2.1F};
    const Index expected[] = {1, 1, 1, 1, 1, 2};
    for (const float x : places)
        rays.set(rays.count++, {Vec3(x, 2.1F, 2.05F), glm::normalize(Vec3(0.01F, -1, 0.02F))});
    caster.nearest(rays, Scope::everything, hits);
    for (std::size_t k = 0; k < rays.count; ++k) {
        EXPECT_EQ(hits[k].body, expected[k]) << places[k];
        EXPECT_EQ(caster.nearest(rays.ray(k), Scope::actors).body, expected[k]) << places[k];
        EXPECT_EQ(hits[k].side, Side::front);
    }
    // A line of the right one's surface sees the right one.
    caster.nearest_from(2, rays, hits);
    EXPECT_EQ(hits[2].body, 2U);
    EXPECT_EQ(hits[0].body, 1U);
}

TEST(Tie, DoesNotDependOnTheOrderInATimeBuffer) {
    constexpr int frames = 9;
    // Two actors' faces all but equally far off, the later one nearer by rounding, and a third that is
    // nearer.
    const FaceNumbers first{10, 20, 10}, second{20, 30, 10};
    const std::vector<FaceRun> runs{{12, 0, 8, 2, 0, 2, 2, 0, first},
                                    {25, 1, 8, 2 - 1e-6F, 0, 2 - 1e-6F, 2 - 1e-6F, 0, second},
                                    {27, 6, 7, 1.5F, 0, 1.5F, 1.5F, 0, second}};
    const std::vector<Index> expected{12, 12, 12, 12, 12, 12, 27, 27, 12};
    std::vector<std::size_t> order{0, 1, 2};
    do {
        RayPacket rays;
        rays.set(0, {Vec3(0), Vec3(0, 0, 1), 5});
        rays.count = 1;
        TimeBuffer buffer(frames);
        buffer.clear(rays);
        for (const std::size_t k : order) buffer.put(0, runs[k]);
        const auto faces = buffer.faces(0);
        EXPECT_EQ(std::vector<Index>(faces.begin(), faces.end()), expected);
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Tie, AllStrategiesAgreeWhereActorsOfOneHeightWalkThroughEachOther) {
    for (const unsigned seed : {1U, 2U}) {
        LinedWorld lined(walkers(seed, 12), 0.3F, 64);
        const StaticLines background = testing::background_of(lined);
        const auto look = [&](VisibilityStrategy& strategy, VisibleLines& visible, int frame) {
            strategy.update({lined.mesh, lined.sight, lined.light, lined.caster, background, frame}, {0, 64},
                            visible, Context(2));
        };
        const std::unique_ptr<VisibilityStrategy> retrace = make_retrace();
        const std::unique_ptr<VisibilityStrategy> others[] = {
            make_back_buffer(lined.world, clock_of_tests), make_temporal_graph(lined.world, clock_of_tests),
            make_events(lined.world, clock_of_tests)};
        VisibleLines expected = make_visible_lines(lined.mesh, lined.sight, lined.light);
        std::vector<VisibleLines> visible(std::size(others), expected);
        std::vector<std::size_t> different(std::size(others), 0);
        std::size_t lines = 0;
        for (int frame = 0; frame < 60; frame += 4) {
            lined.caster.set_poses(poses_at(lined.world, clock_of_tests.time_of(frame)));
            look(*retrace, expected, frame);
            lines += expected.patch.size();
            for (std::size_t k = 0; k < std::size(others); ++k) {
                look(*others[k], visible[k], frame);
                for (std::size_t line = 0; line < expected.patch.size(); ++line)
                    different[k] += visible[k].patch[line] != expected.patch[line] ? 1U : 0U;
            }
        }
        for (const std::size_t count : different) {
            EXPECT_LE(count, lines / 10'000);
            std::printf("%zu of %zu lines differ\n", count, lines);
        }
    }
}

}  // namespace
}  // namespace afterglow
