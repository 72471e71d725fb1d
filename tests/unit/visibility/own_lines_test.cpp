#include "solver/visibility/own_lines.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>

#include "solver/visibility/events.h"
#include "solver/visibility/own_light_lines.h"
#include "tests/support/actors.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::background_of;
using testing::LinedWorld;
using testing::Movements;

constexpr FrameClock clock_of_tests{8};

/// A world of which some of the actors' lines are repeated, and what is kept of those lines.
struct Kept {
    LinedWorld lined;
    SightLines sight;
    LightLines light;
    StaticLines background;
    OwnLines own;
    OwnLightLines own_light;
    VisibleLines visible;

    explicit Kept(World world, Index repeats = 4)
        : lined(std::move(world), 0.4F, 32),
          sight(lined.mesh, lined.world, 32, 3, {repeats, 1}),
          light(lined.mesh, sight, lined.lamps, 16, 4, {repeats, 1}),
          own(lined.world),
          own_light(lined.world),
          visible(make_visible_lines(lined.mesh, sight, light)) {}

    LineScene at(int frame) {
        lined.caster.set_poses(poses_at(lined.world, clock_of_tests.time_of(frame)));
        return {lined.mesh, sight, light, lined.caster, background, frame};
    }
    std::uint64_t show(int frame, const DirectionRange& range = {0, 32}, int threads = 2) {
        const LineScene scene = at(frame);
        std::uint64_t rays = own.update(scene, range, visible, Context(threads));
        if (range.first == 0) rays += own_light.update(scene, visible, Context(threads));
        return rays;
    }
    VisibleLines retraced(int frame) {
        VisibleLines anew = make_visible_lines(lined.mesh, sight, light);
        make_retrace()->update(at(frame), {0, 32}, anew, Context(2));
        return anew;
    }
    std::size_t first_own_line() const { return std::size_t{lined.mesh.static_size()} * 32; }
};

/// The second of the actors shines, and so moves light lines of everybody.
World world_with_moving_lamp(unsigned seed, int actors, Movements movements) {
    World world = testing::random_world(seed, actors, movements);
    if (world.bodies.size() > 2)
        for (Triangle& triangle : world.bodies[2].triangles) triangle.material = 1;
    return world;
}

std::vector<int> frames_in_any_order(unsigned seed) {
    std::vector<int> frames;
    for (int f = -2; f < 36; f += 2) frames.push_back(std::max(0, f));
    std::mt19937 random(seed);
    std::shuffle(frames.begin(), frames.end(), random);
    return frames;
}

TEST(OwnLines, SeeWhatRetraceSeesInFramesInAnyOrder) {
    std::size_t lines = 0, different = 0, of_others = 0;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        Kept kept(world_with_moving_lamp(seed, static_cast<int>(seed),
                                         seed % 2 == 0 ? Movements::turning : Movements::straight),
                  seed % 3 == 0 ? 1 : 4);
        const auto moving_lamp = [&](std::size_t block, Index k) {
            return kept.lined.mesh.body[kept.light.lamp_patch(block, k)] != furniture;
        };
        for (const int frame : frames_in_any_order(seed)) {
            kept.show(frame);
            const VisibleLines expected = kept.retraced(frame);
            for (std::size_t k = kept.first_own_line(); k < expected.patch.size(); ++k) {
                ++lines;
                different += kept.visible.patch[k] != expected.patch[k] ? 1U : 0U;
            }
            for (std::size_t b = 0; b < kept.sight.blocks().size(); ++b) {
                const PatchBlock& block = kept.sight.blocks()[b];
                for (Index k = 0; k < 16; ++k) {
                    if (block.body == furniture && !moving_lamp(b, k)) continue;
                    for (Index lane = 0; lane < block.count; ++lane) {
                        const std::size_t line = kept.light.line(block, k, lane);
                        ++lines;
                        of_others += block.body == furniture ? 1U : 0U;
                        different +=
                            kept.visible.light_contribution[line] != expected.light_contribution[line] ? 1U
                                                                                                       : 0U;
                    }
                }
            }
        }
    }
    std::printf("%zu of %zu lines differ, %zu to moving lamps\n", different, lines, of_others);
    // Only ties may differ.
    EXPECT_LE(different, lines / 10'000);
    EXPECT_GT(of_others, 0U);
}

TEST(OwnLines, LookedAheadAlongSeeWhatRetraceSees) {
    std::size_t lines = 0, different = 0, changed = 0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
        Kept kept(testing::random_world(seed, static_cast<int>(seed), Movements::straight),
                  seed % 3 == 0 ? 1 : 4);
        kept.background = make_static_lines(kept.lined.mesh, kept.sight, kept.light);
        extend_static_lines(kept.background, kept.lined.mesh, kept.sight, kept.light, kept.lined.caster, 32,
                            Context(2));
        const auto events = make_events(kept.lined.world, clock_of_tests, {8, 2});
        for (const int frame : frames_in_any_order(seed)) {
            const LineScene scene = kept.at(frame);
            const std::vector<Index> before = kept.visible.patch;
            // By parts that end before lines are repeated, and after.
            for (const DirectionRange& range : {DirectionRange{0, 5}, {5, 20}, {20, 32}})
                events->update(scene, range, kept.visible, Context(2));
            const VisibleLines expected = kept.retraced(frame);
            for (std::size_t k = kept.first_own_line(); k < expected.patch.size(); ++k) {
                ++lines;
                different += kept.visible.patch[k] != expected.patch[k] ? 1U : 0U;
                changed += kept.visible.patch[k] != before[k] ? 1U : 0U;
            }
        }
    }
    std::printf("%zu of %zu lines differ\n", different, lines);
    // Only ties may differ.
    EXPECT_LE(different, lines / 10'000);
    EXPECT_GT(changed, lines / 10);
}

TEST(OwnLines, DoNotRememberHowAFrameWasReached) {
    const World world = world_with_moving_lamp(11, 5, Movements::turning);
    Kept wanders(world);
    for (const int frame : frames_in_any_order(11)) {
        wanders.show(frame);
        Kept fresh(world);
        fresh.show(frame, {0, 32}, 1);
        EXPECT_EQ(wanders.visible.patch, fresh.visible.patch) << frame;
        EXPECT_EQ(wanders.visible.light_contribution, fresh.visible.light_contribution) << frame;
    }
}

TEST(OwnLines, DoNotDependOnTheDivisionOfDirections) {
    const World world = world_with_moving_lamp(12, 4, Movements::straight);
    Kept whole(world), divided(world);
    for (const int frame : {3, 4, 4, 0}) {
        whole.show(frame);
        for (const DirectionRange range :
             {DirectionRange{0, 5}, DirectionRange{5, 8}, DirectionRange{8, 21}, DirectionRange{21, 32}})
            divided.show(frame, range);
        EXPECT_EQ(whole.visible.patch, divided.visible.patch);
        EXPECT_EQ(whole.visible.light_contribution, divided.visible.light_contribution);
    }
}

TEST(OwnLines, GoOnAfterAStop) {
    const World world = world_with_moving_lamp(13, 4, Movements::turning);
    Kept stopped(world), fresh(world);
    stopped.show(2);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(stopped.own.update(stopped.at(9), {0, 32}, stopped.visible, Context(2, stop.get_token())),
                 Error);
    stopped.show(9);
    fresh.show(9);
    EXPECT_EQ(stopped.visible.patch, fresh.visible.patch);
}

/// Two boxes at rest and one that moves from frame 8 on: across a corner of the room, then past the boxes.
World world_with_rests() {
    World world = testing::small_room();
    world.bodies.resize(1);
    const Quat level(1, 0, 0, 0);
    Path left, right, moving;
    left.keys = {{0, {Vec3(1, 1.13F, 1.5F), level}}};
    right.keys = {{0, {Vec3(3, 1.13F, 1.5F), level}}};
    moving.keys = {{1, {Vec3(3.7F, 2.2F, 4.5F), level}}, {4, {Vec3(2, 1.17F, 1.5F), level}}};
    testing::add_actor(world, "left", Vec3(0.3F), 0, left);
    testing::add_actor(world, "right", Vec3(0.3F), 0, right);
    testing::add_actor(world, "moving", Vec3(0.2F), 0, moving);
    world.duration_s = 4;
    return world;
}

TEST(OwnLines, WhatRestsIsNotTraced) {
    Kept kept(world_with_rests(), 1);
    const auto lines_of = [&](Index body) {
        std::uint64_t patches = 0;
        for (const PatchBlock& block : kept.sight.blocks())
            if (block.body == body) patches += block.count;
        return 32 * patches;
    };
    const auto own_rays = [&](int frame) {
        return kept.own.update(kept.at(frame), {0, 32}, kept.visible, Context(1));
    };
    const std::uint64_t all = lines_of(1) + lines_of(2) + lines_of(3);
    EXPECT_GE(own_rays(0), 2 * all);
    // Nothing moves from frame 0 to frame 8.
    for (const int frame : {5, 8, 0}) EXPECT_EQ(own_rays(frame), 0U) << frame;
    EXPECT_GT(kept.own_light.update(kept.at(0), kept.visible, Context(1)), 0U);
    EXPECT_EQ(kept.own_light.update(kept.at(8), kept.visible, Context(1)), 0U);
    // Then the lines of what moves are traced against the furniture, and few others against few boxes.
    for (const int frame : {9, 20, 32}) {
        const std::uint64_t rays = own_rays(frame);
        EXPECT_GE(rays, lines_of(3)) << frame;
        EXPECT_LT(rays, lines_of(3) + all / 2) << frame;
        const VisibleLines expected = kept.retraced(frame);
        std::size_t different = 0;
        for (std::size_t k = kept.first_own_line(); k < expected.patch.size(); ++k)
            different += kept.visible.patch[k] != expected.patch[k] ? 1U : 0U;
        EXPECT_LE(different, all / 10'000) << frame;
    }
    EXPECT_EQ(own_rays(40), 0U);
}

TEST(OwnLines, AreNoneWithoutActors) {
    World world = testing::small_room();
    world.bodies.resize(1);
    Kept kept(std::move(world));
    EXPECT_EQ(kept.show(0), 0U);
}

}  // namespace
}  // namespace afterglow
