#include "solver/visibility/strategy.h"

#include <random>

#include <gmock/gmock.h>

#include "solver/visibility/events.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::background_of;
using testing::LinedWorld;

constexpr FrameClock clock_of_tests{20};

/// What a strategy that is asked for frames of a world shows.
struct Shown {
    std::unique_ptr<VisibilityStrategy> strategy;
    VisibleLines visible;

    Shown(const LinedWorld& lined, std::unique_ptr<VisibilityStrategy> chosen)
        : strategy(std::move(chosen)), visible(make_visible_lines(lined.mesh, lined.sight, lined.light)) {}

    /// Returns the number of rays.
    std::uint64_t look(LinedWorld& lined, const StaticLines& background, int frame,
                       const DirectionRange& range = {0, 32}) {
        lined.caster.set_poses(poses_at(lined.world, clock_of_tests.time_of(frame)));
        return strategy->update({lined.mesh, lined.sight, lined.light, lined.caster, background, frame},
                                range, visible, Context(2));
    }
};

/// The room with actors on random paths; one goes through walls and out of the room.
World crowded_room(unsigned seed) {
    World world = testing::small_room();
    std::mt19937 random(seed);
    Box near_room;
    near_room.add(Vec3(-1));
    near_room.add(Vec3(5, 3.5F, 6));
    for (int k = 0; k < 4; ++k)
        testing::add_actor(world, "actor", Vec3(0.1F, 0.3F, 0.2F), 0,
                           testing::random_path(random, near_room, 3,
                                                k % 2 == 0 ? testing::Turning::yes : testing::Turning::no));
    return world;
}

TEST(Strategies, BackBufferSeesWhatRetraceSees) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        LinedWorld lined(crowded_room(seed), 0.4F, 32);
        const StaticLines background = background_of(lined);
        Shown retrace(lined, make_retrace());
        Shown back_buffer(lined, make_back_buffer(lined.world, clock_of_tests));
        std::uint64_t rays = 0, all_rays = 0;
        for (const int frame : {0, 7, 20, 44, 44, 60, 7, 61, 3}) {
            all_rays += retrace.look(lined, background, frame);
            rays += back_buffer.look(lined, background, frame);
            std::size_t different = 0, lamp_lines = 0;
            const VisibleLines &visible = back_buffer.visible, &expected = retrace.visible;
            for (std::size_t k = 0; k < visible.patch.size(); ++k)
                different += visible.patch[k] != expected.patch[k] ? 1U : 0U;
            // Only ties (an actor's face in the plane of a wall) may differ.
            EXPECT_LE(different, visible.patch.size() / 10000) << "seed " << seed << " frame " << frame;
            for (std::size_t k = 0; k < visible.light_contribution.size(); ++k)
                lamp_lines += visible.light_contribution[k] != expected.light_contribution[k] ? 1U : 0U;
            EXPECT_LE(lamp_lines, visible.light_contribution.size() / 10000);
        }
        // Most lines meet no actor's box.
        EXPECT_LT(rays, all_rays / 4);
    }
}

TEST(Strategies, AnyDivisionOfTheDirectionsGivesTheSame) {
    LinedWorld lined(crowded_room(4), 0.4F, 32);
    const StaticLines background = background_of(lined);
    for (const bool anew : {true, false}) {
        const auto make = [&] {
            return anew ? make_retrace() : make_back_buffer(lined.world, clock_of_tests);
        };
        Shown whole(lined, make()), parts(lined, make());
        for (const int frame : {12, 13}) {
            whole.look(lined, background, frame);
            for (const DirectionRange range :
                 {DirectionRange{0, 5}, DirectionRange{5, 17}, DirectionRange{17, 32}})
                parts.look(lined, background, frame, range);
            EXPECT_EQ(parts.visible.patch, whole.visible.patch);
            EXPECT_EQ(parts.visible.light_contribution, whole.visible.light_contribution);
        }
    }
}

/// The crowded room, its actors held where they are after a second; they may be on their way nowhere.
World still_room(int actors) {
    World world = crowded_room(6);
    world.bodies.resize(static_cast<std::size_t>(actors) + 1);
    for (std::size_t b = 1; b < world.bodies.size(); ++b) {
        const Pose here = world.bodies[b].path.at(1);
        world.bodies[b].path.keys = {{0, here}, {2, here}};
    }
    return world;
}

TEST(Strategies, NothingIsTracedOnceNothingMoves) {
    for (const int actors : {0, 1, 4}) {
        LinedWorld lined(still_room(actors), 0.4F, 32);
        const StaticLines background = background_of(lined);
        Shown retrace(lined, make_retrace());
        retrace.look(lined, background, 0);
        Shown others[] = {{lined, make_back_buffer(lined.world, clock_of_tests)},
                          {lined, make_temporal_graph(lined.world, clock_of_tests)},
                          {lined, make_events(lined.world, clock_of_tests)}};
        for (Shown& shown : others) {
            const std::uint64_t first = shown.look(lined, background, 0);
            EXPECT_EQ(first > 0, actors > 0);
            for (const int frame : {1, 2, 30, 500, 1}) EXPECT_EQ(shown.look(lined, background, frame), 0U);
            EXPECT_THAT(shown.strategy->work_ahead(), ::testing::IsEmpty());
            std::size_t different = 0;
            for (std::size_t k = 0; k < shown.visible.patch.size(); ++k)
                different += shown.visible.patch[k] != retrace.visible.patch[k] ? 1U : 0U;
            EXPECT_LE(different, shown.visible.patch.size() / 10000);
            EXPECT_EQ(shown.visible.light_contribution, retrace.visible.light_contribution);
        }
    }
}

TEST(Strategies, AStopIsObeyed) {
    LinedWorld lined(crowded_room(5), 0.4F, 32);
    std::stop_source stop;
    stop.request_stop();
    VisibleLines visible = make_visible_lines(lined.mesh, lined.sight, lined.light);
    const StaticLines none;
    try {
        make_retrace()->update({lined.mesh, lined.sight, lined.light, lined.caster, none}, {0, 32}, visible,
                               Context(1, stop.get_token()));
        FAIL() << "must throw";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
}

}  // namespace
}  // namespace afterglow
