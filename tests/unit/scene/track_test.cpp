#include <gmock/gmock.h>

#include "solver/scene/keys.h"
#include "solver/scene/scene.h"

namespace afterglow {
namespace {

const Track<float> ramp{0, {{1.0, 10.0F}, {3.0, 30.0F}}};

TEST(Track, RunsStraightBetweenKeysAndIsConstantOutside) {
    EXPECT_EQ(value_at(ramp, 0.0), 10.0F);
    EXPECT_EQ(value_at(ramp, 1.0), 10.0F);
    EXPECT_FLOAT_EQ(value_at(ramp, 1.5), 15.0F);
    EXPECT_EQ(value_at(ramp, 3.0), 30.0F);
    EXPECT_EQ(value_at(ramp, 99.0), 30.0F);
}

TEST(Track, ShowsTheLaterValueAtAJump) {
    const Track<float> jump{0, {{0.0, 1.0F}, {1.0, 1.0F}, {1.0, 5.0F}, {2.0, 5.0F}}};
    EXPECT_EQ(value_at(jump, 0.999), 1.0F);
    EXPECT_EQ(value_at(jump, 1.0), 5.0F);
    EXPECT_EQ(value_in<float>(jump.keys, 1.0, JumpSide::before), 1.0F);
}

TEST(Track, GivesBackKeysBitForBit) {
    Track<Vec3> track;
    for (int k = 0; k < 50; ++k)
        track.keys.push_back({k / 24.0, Vec3(0.1F * static_cast<float>(k), 1.0F / 3.0F, -7.7F)});
    for (const auto& key : track.keys) EXPECT_EQ(value_at(track, key.time_s), key.value);
}

TEST(Track, TurnsTheShorterWay) {
    const Quat quarter = glm::angleAxis(pi / 2, Vec3(0, 1, 0));
    const Track<Quat> turn{0, {{0.0, Quat(1, 0, 0, 0)}, {1.0, -quarter}}};
    const Vec3 x = value_at(turn, 0.5) * Vec3(1, 0, 0);
    // An eighth of a turn about y takes x towards −z; rounding of a unit quaternion is a few 1e-7.
    EXPECT_NEAR(x.x, std::sqrt(0.5F), 1e-6F);
    EXPECT_NEAR(x.z, -std::sqrt(0.5F), 1e-6F);
}

TEST(Transform, AppliesScaleThenRotationThenTranslation) {
    const Transform t{Vec3(10, 0, 0), glm::angleAxis(pi / 2, Vec3(0, 0, 1)), Vec3(2, 3, 4)};
    const Vec3 p = Vec3(t.matrix() * glm::vec4(1, 0, 1, 1));
    EXPECT_NEAR(p.x, 10, 1e-5F);
    EXPECT_NEAR(p.y, 2, 1e-6F);
    EXPECT_NEAR(p.z, 4, 1e-6F);
}

}  // namespace
}  // namespace afterglow
