#include "solver/sequence/choose.h"

#include <gmock/gmock.h>

#include "tests/support/actors.h"

namespace afterglow {
namespace {

using testing::Movements;

SequenceConfig expecting(int frames) {
    SequenceConfig config;
    config.frames_expected = frames;
    return config;
}

std::string chosen(const World& world, const SequenceConfig& config) {
    const MethodChoice choice = choose_method(world, config);
    return method_name(choice.visibility, choice.solution);
}

TEST(ChooseMethod, BuildsNoMoreThanTheSceneNeeds) {
    const World moving = testing::random_world(1, 3, Movements::turning);
    EXPECT_EQ(chosen(moving, expecting(1)), "full");
    EXPECT_EQ(chosen(moving, expecting(3)), "back-buffer+residual");
    EXPECT_EQ(chosen(moving, expecting(96)), "events");
    EXPECT_EQ(chosen(moving, expecting(0)), "events");

    const World still = testing::random_world(1, 0, Movements::turning);
    EXPECT_EQ(chosen(still, expecting(96)), "back-buffer+residual");
    EXPECT_EQ(chosen(still, expecting(1)), "full");
}

TEST(ChooseMethod, AnActorThatNeverLeavesItsPlaceDoesNotMove) {
    World world = testing::empty_world();
    Path path;
    path.keys = {{0, {Vec3(1, 0, 0), Quat(1, 0, 0, 0)}}, {2, {Vec3(1, 0, 0), Quat(1, 0, 0, 0)}}};
    testing::add_actor(world, "vase", Vec3(0.1F), 0, path);
    EXPECT_EQ(chosen(world, expecting(96)), "back-buffer+residual");
}

TEST(ChooseMethod, FinelyMeshedActorsAreNotLookedAheadFor) {
    std::mt19937 random(1);
    World world = testing::small_room();
    EXPECT_EQ(chosen(world, expecting(96)), "events");
    Body& ball = world.bodies.emplace_back();
    testing::add_ball(ball, Vec3(0), 0.2F, 3, 0);
    // One that rests does not count.
    EXPECT_EQ(chosen(world, expecting(96)), "events");
    ball.path = testing::random_path(random, {Vec3(1), Vec3(2)}, 2, testing::Turning::no);
    EXPECT_EQ(chosen(world, expecting(96)), "back-buffer+residual");
}

TEST(ChooseMethod, WhereMuchOfAllSurfaceMovesNothingIsKept) {
    std::mt19937 random(1);
    World world = testing::small_room();
    // 94 m² of room; a crate has 13.5 m².
    const auto add_crates = [&](int count) {
        for (int k = 0; k < count; ++k)
            testing::add_actor(world, "crate", Vec3(0.75F), 0,
                               testing::random_path(random, {Vec3(1), Vec3(2)}, 2, testing::Turning::no));
    };
    add_crates(2);
    EXPECT_EQ(chosen(world, expecting(3)), "back-buffer+residual");
    add_crates(4);
    EXPECT_EQ(chosen(world, expecting(3)), "full");
    EXPECT_THAT(choose_method(world, expecting(3)).reason, ::testing::HasSubstr("% of all surface moves"));
    EXPECT_EQ(chosen(world, expecting(96)), "events");
    add_crates(90);
    EXPECT_EQ(chosen(world, expecting(96)), "full");
}

TEST(ChooseMethod, SaysWhyUnlessAskedByName) {
    const World world = testing::random_world(2, 3, Movements::straight);
    EXPECT_THAT(choose_method(world, expecting(96)).reason, ::testing::HasSubstr("actors: "));
    SequenceConfig named = expecting(96);
    named.visibility = Visibility::retrace;
    EXPECT_EQ(chosen(world, named), "retrace+residual");
    EXPECT_NE(choose_method(world, named).reason, "");
    named.solution = Solution::progressive;
    EXPECT_EQ(chosen(world, named), "full");
    EXPECT_EQ(choose_method(world, named).reason, "");
}

TEST(MethodName, IsThePairWhereNoMethodHasIt) {
    for (const Method& method : methods())
        EXPECT_EQ(method_name(method.visibility, method.solution), method.name);
    EXPECT_EQ(method_name(static_cast<Visibility>(99), Solution::progressive), "unknown+progressive");
}

}  // namespace
}  // namespace afterglow
