#include "solver/visibility/strategy.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::background_of;
using testing::LinedWorld;

VisibleLines seen_by(VisibilityStrategy& strategy, const LinedWorld& lined, const StaticLines& background) {
    VisibleLines visible = make_visible_lines(lined.mesh, lined.sight, lined.light);
    strategy.update({lined.mesh, lined.sight, lined.light, lined.caster, background},
                    {0, lined.sight.lines_per_patch()}, visible, Context(2));
    return visible;
}

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
        const auto retrace = make_retrace(), back_buffer = make_back_buffer();
        for (const double time : {0.0, 0.35, 1.0, 2.2, 3.0}) {
            lined.caster.set_poses(poses_at(lined.world, time));
            const VisibleLines expected = seen_by(*retrace, lined, background);
            const VisibleLines visible = seen_by(*back_buffer, lined, background);
            std::size_t different = 0;
            for (std::size_t k = 0; k < visible.patch.size(); ++k)
                different += visible.patch[k] != expected.patch[k] ? 1U : 0U;
            // Only ties (an actor's face in the plane of a wall) may differ.
            EXPECT_LE(different, visible.patch.size() / 10000) << "seed " << seed << " time " << time;
            std::size_t lamp_lines = 0;
            for (std::size_t k = 0; k < visible.light_contribution.size(); ++k)
                lamp_lines += visible.light_contribution[k] != expected.light_contribution[k] ? 1U : 0U;
            EXPECT_LE(lamp_lines, visible.light_contribution.size() / 10000);
        }
    }
}

TEST(Strategies, AnyDivisionOfTheDirectionsGivesTheSame) {
    LinedWorld lined(crowded_room(4), 0.4F, 32);
    lined.caster.set_poses(poses_at(lined.world, 0.6));
    const StaticLines background = background_of(lined);
    for (const auto& make : {make_retrace, make_back_buffer}) {
        const VisibleLines whole = seen_by(*make(), lined, background);
        VisibleLines parts = make_visible_lines(lined.mesh, lined.sight, lined.light);
        const LineScene scene{lined.mesh, lined.sight, lined.light, lined.caster, background};
        const auto strategy = make();
        for (const DirectionRange range :
             {DirectionRange{0, 5}, DirectionRange{5, 17}, DirectionRange{17, 32}})
            strategy->update(scene, range, parts, Context(1));
        EXPECT_EQ(parts.patch, whole.patch);
        EXPECT_EQ(parts.light_contribution, whole.light_contribution);
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
