#include "solver/scene/track_keys.h"

#include <cmath>

#include <gmock/gmock.h>

#include "solver/scene/keys.h"
#include "solver/scene/simplify.h"

namespace afterglow {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

Json parse(const char* text) {
    return parse_json(text, "doc");
}

template <class Read>
std::string refusal(const char* text, const Read& read) {
    const Json json = parse(text);
    try {
        read(JsonView(json, "doc"), KeyStyle{});
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

TEST(PositionKeys, ConvertTimesAndLengths) {
    const Json json = parse("[[0, 100, 0, 50], [24, 0, 0, 0]]");
    const auto keys = position_keys(JsonView(json, "doc"), {1 / 24.0, 0.01, KeyStyle::Interpolation::linear});
    ASSERT_THAT(keys, SizeIs(2));
    EXPECT_EQ(keys[0].value, Vec3(1, 0, 0.5F));
    EXPECT_DOUBLE_EQ(keys[1].time_s, 1);
}

TEST(PositionKeys, NameTheKeyOfAnError) {
    EXPECT_THAT(refusal("[[0, 1, 2]]", position_keys), HasSubstr("doc#/0"));
    EXPECT_THAT(refusal("[[0,1,2,3], [1,2,3,\"x\"]]", position_keys), HasSubstr("doc#/1/3"));
    EXPECT_THAT(refusal("[[1,0,0,0], [0.5,0,0,0]]", position_keys), HasSubstr("doc#/1: is earlier"));
    EXPECT_THAT(refusal("[[-1,0,0,0]]", position_keys), HasSubstr("doc#/0"));
    EXPECT_THAT(refusal("[[1e300,0,0,0]]", position_keys), HasSubstr("doc#/0"));
    EXPECT_THAT(refusal("[[0,1e300,0,0]]", position_keys), HasSubstr("single precision"));
    EXPECT_THAT(refusal("[]", position_keys), HasSubstr("at least one key"));
    EXPECT_THAT(refusal("{}", position_keys), HasSubstr("array"));
    EXPECT_THAT(refusal("[7]", position_keys), HasSubstr("doc#/0"));
}

TEST(StepKeys, HoldEachValueUpToTheNext) {
    const Json json = parse("[[0, 1], [2, 5], [3, 0]]");
    const Track<float> track{0, scale_keys(JsonView(json, "doc"), {1, 1, KeyStyle::Interpolation::step})};
    EXPECT_EQ(value_at(track, 1.999), 1.0F);
    EXPECT_EQ(value_at(track, 2), 5.0F);
    EXPECT_EQ(value_at(track, 2.999), 5.0F);
    EXPECT_EQ(value_at(track, 9), 0.0F);
}

TEST(RotationKeys, TurnEvenlyAnyNumberOfTimesAboutOneAxis) {
    const Json json = parse("[[0, 0,2,0, 0], [4, 0,1,0, 720], [5, 0,1,0, 540]]");
    const Track<Quat> track{0, rotation_keys(JsonView(json, "doc"), {})};
    for (double time = 0; time <= 5; time += 0.125) {
        const double degrees = time <= 4 ? 180 * time : 720 - 180 * (time - 4);
        const Quat expected = glm::angleAxis(static_cast<float>(glm::radians(degrees)), Vec3(0, 1, 0));
        EXPECT_LT(angle_between(value_at(track, time), expected), 1e-5) << time;
    }
}

TEST(RotationKeys, RejectTurnsAboutNothing) {
    EXPECT_THAT(refusal("[[0, 0,0,0, 90]]", rotation_keys), HasSubstr("axis"));
    EXPECT_THAT(refusal("[[0, 0,1,0, 1e9]]", rotation_keys), HasSubstr("100 times"));
}

TEST(ScaleAndColourKeys, RejectNegativeValues) {
    EXPECT_THAT(refusal("[[0, -1]]", scale_keys), HasSubstr("doc#/0"));
    EXPECT_THAT(refusal("[[0, 1, -1, 0]]", colour_keys), HasSubstr("doc#/0"));
    EXPECT_EQ(refusal("[[0, 0]]", scale_keys), "accepted");
}

}  // namespace
}  // namespace afterglow
