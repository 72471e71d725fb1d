#include "solver/visibility/events.h"

#include <algorithm>
#include <deque>
#include <random>

#include <gmock/gmock.h>

#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::background_of;
using testing::LinedWorld;
using testing::Turning;

constexpr FrameClock clock_of_tests{10};

/// A world with its lines, and a strategy that is asked for frames.
struct Watched {
    LinedWorld lined;
    StaticLines background;
    std::unique_ptr<VisibilityStrategy> strategy;
    VisibleLines visible;

    explicit Watched(World world, const EventsConfig& config = {})
        : lined(std::move(world), 0.4F, 32),
          background(background_of(lined)),
          strategy(make_events(lined.world, clock_of_tests, config)),
          visible(make_visible_lines(lined.mesh, lined.sight, lined.light)) {}

    void show(int frame, const DirectionRange& range = {0, 32}, const Context& context = Context(2)) {
        lined.caster.set_poses(poses_at(lined.world, clock_of_tests.time_of(frame)));
        strategy->update({lined.mesh, lined.sight, lined.light, lined.caster, background, frame}, range,
                         visible, context);
    }
    VisibleLines retraced(int frame) {
        lined.caster.set_poses(poses_at(lined.world, clock_of_tests.time_of(frame)));
        VisibleLines anew = make_visible_lines(lined.mesh, lined.sight, lined.light);
        make_retrace()->update({lined.mesh, lined.sight, lined.light, lined.caster, background, frame},
                               {0, 32}, anew, Context(2));
        return anew;
    }
};

struct Disagreement {
    std::size_t lines = 0, different = 0;
    void add(const VisibleLines& a, const VisibleLines& b) {
        lines += a.patch.size() + a.light_contribution.size();
        for (std::size_t k = 0; k < a.patch.size(); ++k) different += a.patch[k] != b.patch[k] ? 1U : 0U;
        for (std::size_t k = 0; k < a.light_contribution.size(); ++k)
            different += a.light_contribution[k] != b.light_contribution[k] ? 1U : 0U;
    }
};

/// The room with actors on random paths, through walls and each other, some thin and fast.
World crowded_room(unsigned seed, int actors, Turning turning) {
    World world = testing::small_room();
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> size(0.02F, 0.5F);
    Box near_room;
    near_room.add(Vec3(-1));
    near_room.add(Vec3(5, 3.5F, 6));
    for (int k = 0; k < actors; ++k)
        testing::add_actor(world, "actor", Vec3(size(random), size(random), size(random)), 0,
                           testing::random_path(random, near_room, 1 + k % 4, turning));
    return world;
}

TEST(Events, ShowWhatRetraceShowsInEveryFrame) {
    Disagreement found;
    for (const Turning turning : {Turning::no, Turning::yes}) {
        for (const int actors : {1, 4, 12}) {
            Watched watched(crowded_room(static_cast<unsigned>(actors), actors, turning));
            for (int frame = 0; frame < 30; frame += 1 + actors / 4) {
                watched.show(frame);
                found.add(watched.visible, watched.retraced(frame));
            }
        }
    }
    // Only ties may differ: lines through an edge, and faces that lie in another.
    EXPECT_LE(found.different, found.lines / 10'000);
    std::printf("%zu of %zu lines differ\n", found.different, found.lines);
}

TEST(Events, DoNotDependOnTheOrderOfFrames) {
    const World world = crowded_room(5, 4, Turning::yes);
    Watched forward(world), scattered(world, {8});
    std::vector<VisibleLines> expected;
    for (int frame = 0; frame < 24; ++frame) {
        forward.show(frame);
        expected.push_back(forward.visible);
    }
    std::vector<int> order{23, 22, 21, 3, 4, 5, 4, 3, 16, 15, 8, 7, 0, 20, 20, 1};
    for (const int frame : order) {
        scattered.show(frame);
        EXPECT_EQ(scattered.visible.patch, expected[static_cast<std::size_t>(frame)].patch) << frame;
        EXPECT_EQ(scattered.visible.light_contribution,
                  expected[static_cast<std::size_t>(frame)].light_contribution)
            << frame;
    }
}

TEST(Events, DoNotDependOnTheDivisionOfDirectionsOrTheThreads) {
    const World world = crowded_room(6, 3, Turning::no);
    Watched whole(world), divided(world);
    for (const int frame : {3, 4, 9}) {
        whole.show(frame, {0, 32}, Context(1));
        if (frame == 3) {
            divided.show(frame, {0, 5}, Context(3));
            divided.show(frame, {5, 16}, Context(2));
        }
        divided.show(frame, {frame == 3 ? 16U : 0U, 32}, Context(4));
        EXPECT_EQ(divided.visible.patch, whole.visible.patch);
        EXPECT_EQ(divided.visible.light_contribution, whole.visible.light_contribution);
    }
}

/// Another path for a random actor, from a random time on in one case of two.
void change_a_path(Watched& watched, std::mt19937& random, Turning turning) {
    Box near_room;
    near_room.add(Vec3(-1));
    near_room.add(Vec3(5, 3.5F, 6));
    World& world = watched.lined.world;
    const auto actor = static_cast<Index>(1 + random() % (world.bodies.size() - 1));
    const Path before = world.bodies[actor].path;
    Path path = testing::random_path(random, near_room, 1 + static_cast<int>(random() % 4), turning);
    if (random() % 2 == 0) {
        // As before up to a time, and a jump then.
        const double from_s = 0.1 * static_cast<double>(random() % 30);
        std::erase_if(path.keys, [&](const Key<Pose>& key) { return key.time_s < from_s; });
        Path joined;
        for (const Key<Pose>& key : before.keys)
            if (key.time_s < from_s) joined.keys.push_back(key);
        joined.keys.push_back({from_s, before.at(from_s)});
        joined.keys.insert(joined.keys.end(), path.keys.begin(), path.keys.end());
        path = joined;
    }
    world.bodies[actor].path = path;
    const auto kept =
        watched.strategy->follow_path({watched.lined.mesh, watched.lined.sight, watched.lined.light,
                                       watched.lined.caster, watched.background, 0},
                                      actor, before, Context(2));
    ASSERT_TRUE(kept.has_value());
    EXPECT_GE(*kept, 0);
    EXPECT_LE(*kept, 1);
}

TEST(Events, FollowChangedPathsAsIfBegunAnew) {
    Disagreement found;
    for (const Turning turning : {Turning::no, Turning::yes}) {
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
            std::mt19937 random(seed);
            Watched edited(crowded_room(seed, 1 + static_cast<int>(seed), turning), {16, 16});
            for (int round = 0; round < 6; ++round) {
                // In two parts, so that events are known by ranges.
                const int frame = static_cast<int>(random() % 30);
                edited.show(frame, {0, 12});
                edited.show(frame, {12, 32});
                change_a_path(edited, random, turning);
                // On the same lines: how far they are lifted depends on where actors begin.
                const LinedWorld& lined = edited.lined;
                const auto fresh = make_events(lined.world, clock_of_tests, {16, 16});
                VisibleLines anew = make_visible_lines(lined.mesh, lined.sight, lined.light);
                for (const int f : {frame, frame + 1, static_cast<int>(random() % 30)}) {
                    edited.show(f);
                    fresh->update({lined.mesh, lined.sight, lined.light, lined.caster, edited.background, f},
                                  {0, 32}, anew, Context(2));
                    found.add(edited.visible, anew);
                }
            }
        }
    }
    // Ties only, as above.
    EXPECT_LE(found.different, found.lines / 10'000);
    std::printf("%zu of %zu lines differ\n", found.different, found.lines);
}

TEST(Events, APathThatIsTheSameInAWindowKeepsAllOfIt) {
    Watched watched(crowded_room(2, 3, Turning::no), {16, 16});
    watched.show(3);
    Path& path = watched.lined.world.bodies[1].path;
    const Path before = path;
    ASSERT_EQ(before.keys.back().time_s, 2);
    path.keys.push_back({3, before.at(0)});
    const LineScene scene{watched.lined.mesh,   watched.lined.sight, watched.lined.light,
                          watched.lined.caster, watched.background,  3};
    EXPECT_EQ(watched.strategy->follow_path(scene, 1, before, Context(2)), 1.0);
    const Path all_new = path;
    path.keys = {{0, {Vec3(2, 1, 2), Quat(1, 0, 0, 0)}}, {4, {Vec3(2, 1, 3), Quat(1, 0, 0, 0)}}};
    const double kept = watched.strategy->follow_path(scene, 1, all_new, Context(2)).value();
    EXPECT_GT(kept, 0.2);
    EXPECT_LT(kept, 1);
}

TEST(Events, GoOnAfterAStop) {
    Watched watched(crowded_room(7, 4, Turning::yes));
    watched.show(2);
    std::stop_source stop;
    stop.request_stop();
    // Frame 100 lies in another window, whose events must be found.
    EXPECT_THROW(watched.show(100, {0, 32}, Context(2, stop.get_token())), Error);
    watched.show(3);
    Watched fresh(crowded_room(7, 4, Turning::yes));
    fresh.show(3);
    EXPECT_EQ(watched.visible.patch, fresh.visible.patch);
}

TEST(Events, DoNotDependOnTheWindows) {
    for (const Turning turning : {Turning::no, Turning::yes}) {
        const World world = crowded_room(11, 4, turning);
        Watched whole(world, {128, 128});
        std::deque<Watched> divided;
        for (const EventsConfig config : {EventsConfig{}, {128, 1}, {16, 3}, {1, 1}})
            divided.emplace_back(world, config);
        Disagreement found;
        for (int frame = 0; frame < 45; ++frame) {
            whole.show(frame);
            for (Watched& watched : divided) {
                watched.show(frame);
                found.add(watched.visible, whole.visible);
            }
        }
        EXPECT_LE(found.different, found.lines / 100'000);
        std::printf("%zu of %zu lines differ\n", found.different, found.lines);
    }
}

TEST(Events, BeginWithAShortWindow) {
    Watched watched(crowded_room(5, 2, Turning::no));
    for (const int frame : {7, 14, 15, 46, 47, 3}) watched.show(frame);
    std::vector<FrameSpan> windows;
    for (const WorkAhead& work : watched.strategy->work_ahead()) windows.push_back(work.frames);
    EXPECT_THAT(windows, ::testing::ElementsAre(FrameSpan{7, 14}, FrameSpan{15, 46}, FrameSpan{47, 174},
                                                FrameSpan{0, 6}));
}

TEST(EventWindow, HoldsEachFrameOnce) {
    for (const EventsConfig config : {EventsConfig{}, {1, 1}, {5, 2}, {100, 7}, {4, 9}}) {
        for (const int start : {0, 3, 250}) {
            int next = 0;
            while (next < 1000) {
                const FrameSpan window = event_window(next, start, config);
                ASSERT_EQ(window.first, next);
                ASSERT_GE(window.count(), 1);
                ASSERT_LE(window.count(), config.frames_per_window);
                for (int f = window.first; f <= window.last; ++f)
                    ASSERT_EQ(event_window(f, start, config), window);
                next = window.last + 1;
            }
        }
    }
    EXPECT_EQ(event_window(2'000'000'000, 5, {}).count(), 128);
}

TEST(Events, AreNoneWhereNothingMoves) {
    World world = testing::small_room();
    world.bodies.resize(1);
    Watched watched(std::move(world));
    watched.show(0);
    watched.show(50);
    EXPECT_EQ(watched.visible.patch, watched.retraced(50).patch);
}

TEST(Events, OfAKnotDoNotSurviveIt) {
    // A box that comes to stand before the lamp on frame 10 exactly, waits, jumps away and comes back turned.
    World world = testing::small_room();
    world.bodies.resize(1);
    const Quat level(1, 0, 0, 0), turned = glm::angleAxis(0.7F, Vec3(0, 1, 0));
    Path path;
    path.keys = {{0, {Vec3(0.5F, 1.03F, 1), level}},
                 {1, {Vec3(2, 2.03F, 2.53F), level}},
                 {1.5, {Vec3(2, 2.03F, 2.53F), level}},
                 {1.5, {Vec3(0.5F, 1.03F, 4), turned}},
                 {2, {Vec3(2, 2.03F, 2.53F), turned}}};
    testing::add_actor(world, "box", Vec3(0.3F), 0, path);
    Watched watched(std::move(world), {7});
    for (int frame = 0; frame < 25; ++frame) {
        watched.show(frame);
        Disagreement found;
        found.add(watched.visible, watched.retraced(frame));
        EXPECT_LE(found.different, found.lines / 10'000) << frame;
    }
}

TEST(Events, OfFarFramesAreFound) {
    Watched watched(crowded_room(8, 2, Turning::no));
    watched.show(100'000);
    EXPECT_EQ(watched.visible.patch, watched.retraced(100'000).patch);
}

TEST(Events, OfAWindowOfNoFramesAreRefused) {
    const World world = testing::small_room();
    EXPECT_THROW(make_events(world, clock_of_tests, {0}), Error);
    EXPECT_THROW(make_events(world, clock_of_tests, {8, 0}), Error);
}

}  // namespace
}  // namespace afterglow
