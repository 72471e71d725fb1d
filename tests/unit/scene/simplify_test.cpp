#include "solver/scene/simplify.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "solver/scene/keys.h"

namespace afterglow {
namespace {

constexpr double tolerance = 1e-4;

template <class T>
std::vector<double> times_of(const std::vector<Key<T>>& keys) {
    std::vector<double> out;
    for (const auto& key : keys) out.push_back(key.time_s);
    return out;
}

/// One key a frame along straight runs between corners, as an exporter writes it.
std::vector<Key<Vec3>> sampled(const std::vector<Key<Vec3>>& corners) {
    std::vector<Key<Vec3>> out;
    for (double frame = 0; frame / 24.0 <= corners.back().time_s; ++frame)
        out.push_back({frame / 24.0, value_in<Vec3>(corners, frame / 24.0)});
    return out;
}

TEST(Simplify, RecoversTheCornersOfASampledWalk) {
    const std::vector<Key<Vec3>> corners{{0.0, Vec3(0)}, {1.0, Vec3(1, 0, 2)}, {2.5, Vec3(1, 0, -3)}};
    EXPECT_THAT(times_of(simplified(sampled(corners), tolerance)), testing::ElementsAre(0.0, 1.0, 2.5));
}

TEST(Simplify, KeepsBothEndsOfARest) {
    // The rest is one frame long, and what follows is so slow that the tolerance alone would swallow it.
    const std::vector<Key<Vec3>> keys{{0, Vec3(0)},
                                      {1, Vec3(1e-5F, 0, 0)},
                                      {2, Vec3(1e-5F, 0, 0)},
                                      {3, Vec3(2e-5F, 0, 0)},
                                      {4, Vec3(1, 0, 0)}};
    EXPECT_THAT(times_of(simplified(keys, tolerance)), testing::IsSupersetOf({1.0, 2.0}));
}

TEST(Simplify, NeverMergesAJumpAway) {
    const std::vector<Key<float>> keys{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {3, 1}};
    const auto out = simplified(keys, 0.5);
    ASSERT_EQ(out.size(), 4U);
    EXPECT_EQ(out[1].time_s, out[2].time_s);
    EXPECT_EQ(out[3].time_s, 3.0);
}

TEST(Simplify, DropsRepeatsThatCanNeverShow) {
    const std::vector<Key<float>> keys{{0, 0}, {1, 1}, {1, 1}, {2, 2}, {3, 0}, {3, 9}, {3, 1}, {4, 1}};
    const auto out = simplified(keys, 1e-6);
    EXPECT_THAT(times_of(out), testing::ElementsAre(0, 2, 3, 3, 4));
    EXPECT_EQ(out[3].value, 1.0F);
}

TEST(Simplify, ReducesAConstantTrackToOneKey) {
    const std::vector<Key<Vec3>> keys{{0, Vec3(1)}, {1, Vec3(1)}, {1, Vec3(1.00001F)}, {2, Vec3(1)}};
    EXPECT_EQ(simplified(keys, tolerance).size(), 1U);
}

TEST(Simplify, MergesASteadyTurnButNotThroughHalfATurn) {
    std::vector<Key<Quat>> keys;
    for (int k = 0; k <= 48; ++k)
        keys.push_back({k / 24.0, glm::angleAxis(2 * pi * static_cast<float>(k) / 48, Vec3(0, 1, 0))});
    const auto out = simplified(keys, tolerance);
    EXPECT_LE(out.size(), 4U);
    EXPECT_GE(out.size(), 3U);
    for (const auto& key : keys)
        EXPECT_LE(angle_between(value_in<Quat>(out, key.time_s), key.value), tolerance + 1e-6);
}

TEST(Simplify, StaysWithinItsToleranceForAnyTrack) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    for (int round = 0; round < 200; ++round) {
        // Random walks in velocity with rests and jumps: long smooth stretches that end suddenly.
        std::vector<Key<Vec3>> keys;
        Vec3 position(0), velocity(0);
        double time = 0;
        for (int k = 0; k < 100; ++k) {
            if (random() % 10 == 0) velocity = Vec3(normal(random), normal(random), 0);
            if (random() % 15 == 0) velocity = Vec3(0);
            position += 0.1F * velocity + 1e-5F * Vec3(normal(random), 0, 0) * static_cast<float>(round % 2);
            keys.push_back({time, position});
            if (random() % 20 != 0) time += 0.1;
        }
        const auto out = simplified(keys, tolerance);
        EXPECT_LT(out.size(), keys.size());
        for (const auto& key : keys) {
            // A time with several keys shows the first before it and the last from it on.
            const auto after = value_in<Vec3>(keys, key.time_s);
            const auto before = value_in<Vec3>(keys, key.time_s, JumpSide::before);
            EXPECT_LE(glm::length(value_in<Vec3>(out, key.time_s) - after), 1.01 * tolerance);
            EXPECT_LE(glm::length(value_in<Vec3>(out, key.time_s, JumpSide::before) - before),
                      1.01 * tolerance);
        }
    }
}

TEST(Simplify, HandlesAMillionKeysInNearLinearTime) {
    // Quadratic work would be 10¹² tests and run into the test's time limit.
    std::vector<Key<float>> keys;
    for (int k = 0; k < 1'000'000; ++k) keys.push_back({static_cast<double>(k), static_cast<float>(k)});
    EXPECT_EQ(simplified(keys, 0.5).size(), 2U);
}

TEST(SimplifyTracks, JudgesScalarsRelativeToTheirLargestValue) {
    Tracks tracks;
    tracks.material_emission.push_back({0, {{0, 0.0F}, {1, 5000.1F}, {2, 10000.0F}}});
    tracks.material_emission.push_back({1, {{0, 0.0F}, {1, 0.6F}, {2, 1.0F}}});
    simplify_tracks(tracks, {});
    EXPECT_EQ(tracks.material_emission[0].keys.size(), 2U);
    EXPECT_EQ(tracks.material_emission[1].keys.size(), 3U);
}

TEST(SimplifyTracks, RejectsATolerance) {
    LoadConfig config;
    config.collinear_tolerance_m = -1;
    Tracks tracks;
    EXPECT_THROW(simplify_tracks(tracks, config), Error);
}

TEST(AngleBetween, IsAccurateForTinyAngles) {
    const Quat a = glm::angleAxis(1.0F, Vec3(0, 0, 1));
    const Quat b = glm::angleAxis(1.0F + 1e-4F, Vec3(0, 0, 1));
    // Components of unit quaternions carry 6e-8 of rounding; an arc cosine would be off by 5e-4.
    EXPECT_NEAR(angle_between(a, b), 1e-4, 1e-6);
    EXPECT_NEAR(angle_between(a, -a), 0, 1e-6);
}

}  // namespace
}  // namespace afterglow
