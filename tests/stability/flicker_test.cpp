// Where nothing can change, nothing may flicker: light and picture keep every bit.
#include "tests/support/flicker.h"

#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "solver/sequence/parts.h"
#include "tests/support/worlds.h"
#include "tests/unit/sequence/quick_sequences.h"

namespace afterglow {
namespace {

SequenceConfig following() {
    SequenceConfig config;
    config.visibility = Visibility::events;
    config.solution = Solution::residual;
    config.patch_size_m = 0.4;
    config.rays_per_patch = 64;
    config.quality = Quality::draft;
    config.asked_error = 0.02;
    config.width = 48;
    config.height = 32;
    config.revisions = Revisions::final_only;
    return config;
}

const std::vector<Rgb>& light_of(SequenceState& state) {
    return state.parts().kept_light->state->irradiance;
}

bool same_bits(std::span<const Rgb> a, std::span<const Rgb> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

/// Walks, rests for a while, and walks on.
Path with_a_rest(const Vec3& from, const Vec3& here, const Vec3& to, double rest_s, double on_s) {
    const Quat turned = glm::angleAxis(0.8F, Vec3(0, 1, 0));
    Path path;
    path.keys = {{0, {from, Quat(1, 0, 0, 0)}},
                 {rest_s, {here, turned}},
                 {on_s, {here, turned}},
                 {on_s + 1, {to, turned}}};
    return path;
}

TEST(Flicker, IsTheDeviationOfIndependentNoise) {
    std::mt19937 random(3);
    std::normal_distribution<float> noise(0, 0.05F);
    Picture even(32, 32);
    even.pixels.assign(1024, Rgb(2));
    std::vector<Picture> truth(40, even), shown = truth;
    for (std::size_t f = 0; f < shown.size(); ++f)
        for (std::size_t k = 0; k < 1024; ++k) {
            const auto time = static_cast<float>(f);
            truth[f].pixels[k] += 0.01F * time;
            // An error that stays and one that grows evenly count for nothing.
            shown[f].pixels[k] = truth[f].pixels[k] + Rgb(0.3F + 0.02F * time + noise(random),
                                                          0.3F + noise(random), noise(random));
        }
    const double mean = 2 + 0.01 * 19.5;
    EXPECT_NEAR(testing::flicker(shown, truth, 1) * mean, 0.05, 0.002);
    EXPECT_NEAR(testing::flicker(shown, truth, 8) * mean, 0.05 / 8, 0.001);
    EXPECT_EQ(testing::flicker(truth, truth, 1), 0);
}

TEST(Flicker, IsNoneWhileAllActorsRest) {
    World world = testing::small_room();
    world.bodies[1].path =
        with_a_rest(Vec3(0.6F, 0.9F, 3), Vec3(3.2F, 0.9F, 2.5F), Vec3(3, 0.9F, 1), 0.4, 0.8);
    testing::add_actor(world, "other", Vec3(0.2F, 0.2F, 0.3F), 0,
                       with_a_rest(Vec3(3, 0.5F, 4), Vec3(1, 2, 2), Vec3(1, 0.4F, 4), 0.3, 0.9));
    // At 24 frames a second both rest from frame 10 to frame 19.
    for (const double asked : {0.1, 0.02, 0.002}) {
        SequenceConfig config = following();
        config.asked_error = asked;
        SequenceState state = make_state(world, config, Context(2));
        std::vector<Picture> resting;
        std::vector<Rgb> light;
        bool moved = false;
        Picture before;
        for (int frame = 0; frame <= 22; ++frame) {
            Picture picture = testing::picture_of(state, frame);
            if (frame == 10) light = light_of(state);
            if (frame >= 10 && frame <= 19) {
                EXPECT_TRUE(same_bits(light_of(state), light)) << frame;
                resting.push_back(picture);
                EXPECT_TRUE(same_bits(picture.pixels, resting[0].pixels)) << frame;
            } else if (frame > 0) {
                moved = moved || !same_bits(picture.pixels, before.pixels);
            }
            before = std::move(picture);
        }
        EXPECT_TRUE(moved);
        const std::vector<Picture> truth(resting.size(), resting[0]);
        EXPECT_EQ(testing::flicker(resting, truth, 1), 0) << asked;
    }
}

/// Two rooms with nothing between them but walls, in each a lamp and furniture; the camera stands in the
/// second, `actors` move in the first.
World two_rooms(unsigned seed) {
    World world = testing::empty_world(0.6F, Vec3(10, 1.5F, 4.7F));
    world.materials.push_back(testing::diffuse("pale", Rgb(0.8F, 0.7F, 0.6F)));
    Body& rooms = world.bodies[furniture];
    for (const float x : {0.0F, 8.0F}) {
        const Vec3 at(x, 0, 0);
        testing::add_box(rooms, at, at + Vec3(4, 3, 5), 0, testing::Facing::inwards);
        testing::add_quad(rooms, at + Vec3(1.5F, 2.98F, 2), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
        testing::add_box(rooms, at + Vec3(0.5F, 0.7F, 0.5F), at + Vec3(1.8F, 0.75F, 1.5F), 2);
    }
    std::mt19937 random(seed);
    const Box within{Vec3(0.5F, 0.5F, 0.5F), Vec3(3.5F, 2.2F, 4.5F)};
    for (const auto turning : {testing::Turning::no, testing::Turning::yes}) {
        Path path = testing::random_path(random, within, 4, turning);
        for (Key<Pose>& key : path.keys) key.time_s *= 0.4;
        testing::add_actor(world, turning == testing::Turning::no ? "slider" : "turner",
                           Vec3(0.3F, 0.2F, 0.25F), 2, path);
    }
    world.duration_s = 1.6;
    return world;
}

TEST(Flicker, IsNoneInASealedRoomBesideOneInWhichActorsMove) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        SequenceConfig config = following();
        config.asked_error = seed == 3 ? 0.1 : 0.01;
        config.picture_tolerance = 0;
        SequenceState state = make_state(two_rooms(seed), config, Context(2));
        const auto frames = {0, 1, 2, 3, 4, 5, 6, 7, 8, 20, 19, 18, 3, 4};
        std::vector<Picture> pictures;
        std::vector<Rgb> sealed, moving;
        bool moved = false;
        for (const int frame : frames) {
            pictures.push_back(testing::picture_of(state, frame));
            std::vector<Rgb> here, there;
            const SequenceState::Parts& parts = state.parts();
            for (Index p = 0; p < parts.mesh.static_size(); ++p)
                (parts.mesh.centre[p].x > 6 ? here : there).push_back(light_of(state)[p]);
            if (pictures.size() == 1) sealed = here;
            EXPECT_TRUE(same_bits(here, sealed)) << "seed " << seed << " frame " << frame;
            EXPECT_TRUE(same_bits(pictures.back().pixels, pictures[0].pixels))
                << "seed " << seed << " frame " << frame;
            moved = moved || (!moving.empty() && !same_bits(there, moving));
            moving = there;
        }
        EXPECT_TRUE(moved);
    }
}

}  // namespace
}  // namespace afterglow
