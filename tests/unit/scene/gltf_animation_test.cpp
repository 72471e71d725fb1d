#include "solver/scene/gltf_animation.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

/// Two nodes; the animation under test moves the first.
struct Animated {
    GlbBuilder builder;

    Animated() {
        builder.json["nodes"] = Json::array({{{"name", "ball"}}, {{"name", "box"}}});
        builder.add_scalars({0});  // so that there is a buffer whatever the test adds
    }

    Animated& add(const char* path, const std::vector<float>& times, const std::vector<float>& values,
                  const char* interpolation = "LINEAR", int node = 0) {
        const bool turns = std::string(path) == "rotation";
        const int input = builder.add_scalars(times);
        const int output = turns ? builder.add_vec4(values) : builder.add_vec3(values);
        builder.json["animations"].push_back(
            {{"channels", Json::array({{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}})},
             {"samplers",
              Json::array({{{"input", input}, {"output", output}, {"interpolation", interpolation}}})}});
        return *this;
    }
    Json& channel() { return builder.json["animations"][0]["channels"][0]; }
    Scene read() const { return builder.read(); }
    [[nodiscard]] Error error() const {
        return error_of([&] { read(); });
    }
};

const std::vector<float> two_points = {0, 0, 0, 6, 0, 0};

TEST(GltfAnimation, LinearKeysAreKept) {
    const Scene scene = Animated().add("translation", {0, 1, 2}, {0, 0, 0, 1, 2, 3, 4, 5, 6}).read();
    ASSERT_EQ(scene.tracks.node_translation.size(), 1U);
    const auto& track = scene.tracks.node_translation[0];
    EXPECT_EQ(track.target, 0U);
    ASSERT_EQ(track.keys.size(), 3U);
    EXPECT_EQ(track.keys[1].time_s, 1.0);
    EXPECT_EQ(track.keys[2].value, Vec3(4, 5, 6));
    EXPECT_EQ(scene.duration_s, 2.0);
    EXPECT_EQ(scene.frames_per_second, 24.0);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfAnimation, RotationsAreTurnedToUnitLength) {
    const Scene scene = Animated().add("rotation", {0, 1}, {0, 0, 0, 1, 0, 0.61F, 0, 0.8F}).read();
    ASSERT_EQ(scene.tracks.node_rotation.size(), 1U);
    const Quat turned = scene.tracks.node_rotation[0].keys[1].value;
    EXPECT_NEAR(glm::length(turned), 1, 1e-6);
    EXPECT_NEAR(turned.y / turned.w, 0.61 / 0.8, 1e-6);
    EXPECT_THAT(Animated().add("rotation", {0}, {0, 0, 0, 0}).error().what(), HasSubstr("unit length"));
}

TEST(GltfAnimation, StepsJump) {
    const Scene scene = Animated().add("translation", {0, 1, 2}, {0, 0, 0, 1, 0, 0, 2, 0, 0}, "STEP").read();
    const auto& keys = scene.tracks.node_translation[0].keys;
    ASSERT_EQ(keys.size(), 5U);
    const double times[] = {0, 1, 1, 2, 2};
    const float values[] = {0, 0, 1, 1, 2};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(keys[i].time_s, times[i]);
        EXPECT_EQ(keys[i].value.x, values[i]);
    }
}

TEST(GltfAnimation, CubicSplinesAreSampledOnceAFrame) {
    // x(t) = t³ over one second: values 0 and 1, slopes 0 and 3. A Hermite spline gives it exactly.
    const Scene scene =
        Animated()
            .add("translation", {0, 1}, {9, 9, 9, 0, 0, 0, 0, 0, 0, 3, 0, 0, 1, 0, 0, 9, 9, 9}, "CUBICSPLINE")
            .read();
    EXPECT_EQ(warnings_with(scene, "sampled 24 times a second"), 1);
    const auto& keys = scene.tracks.node_translation[0].keys;
    ASSERT_EQ(keys.size(), 25U);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const double t = static_cast<double>(i) / 24;
        EXPECT_DOUBLE_EQ(keys[i].time_s, t);
        EXPECT_NEAR(keys[i].value.x, t * t * t, 1e-6);
    }
}

TEST(GltfAnimation, SplineRotationsStayRotations) {
    const std::vector<float> still = {0, 0, 0, 0};
    std::vector<float> values;
    for (const auto& part : {still, {0, 0, 0, 1}, {0, 5, 0, 0}, {0, 0, 5, 0}, {0, 1, 0, 0}, still})
        values.insert(values.end(), part.begin(), part.end());
    const Scene scene = Animated().add("rotation", {0, 2}, values, "CUBICSPLINE").read();
    ASSERT_EQ(scene.tracks.node_rotation[0].keys.size(), 49U);
    for (const auto& key : scene.tracks.node_rotation[0].keys) EXPECT_NEAR(glm::length(key.value), 1, 1e-6);
}

TEST(GltfAnimation, SplinesOverHugeTimesAreRefused) {
    std::vector<float> values(18, 0.0F);
    EXPECT_EQ(Animated().add("translation", {0, 1e6F}, values, "CUBICSPLINE").error().kind(),
              ErrorKind::too_large);
}

TEST(GltfAnimation, AllAnimationsPlayTogether) {
    const Scene scene = Animated()
                            .add("translation", {0, 1}, two_points, "LINEAR", 1)
                            .add("translation", {0, 3}, two_points, "LINEAR", 0)
                            .add("rotation", {0}, {0, 0, 0, 1}, "LINEAR", 1)
                            .read();
    ASSERT_EQ(scene.tracks.node_translation.size(), 2U);
    EXPECT_EQ(scene.tracks.node_translation[0].target, 0U);
    EXPECT_EQ(scene.tracks.node_translation[1].target, 1U);
    ASSERT_EQ(scene.tracks.node_rotation.size(), 1U);
    EXPECT_EQ(scene.duration_s, 3.0);
}

TEST(GltfAnimation, TheLaterOfTwoMotionsWinsWithAWarning) {
    const Scene scene = Animated()
                            .add("translation", {0, 1}, two_points)
                            .add("translation", {0, 1}, {0, 0, 0, 0, 7, 0})
                            .read();
    ASSERT_EQ(scene.tracks.node_translation.size(), 1U);
    EXPECT_EQ(scene.tracks.node_translation[0].keys[1].value, Vec3(0, 7, 0));
    EXPECT_EQ(warnings_with(scene, "second motion of \"ball\""), 1);
}

TEST(GltfAnimation, ScaleKeepsItsFirstValue) {
    Scene scene = Animated().add("scale", {0, 1}, {2, 2, 2, 3, 3, 3}).read();
    EXPECT_EQ(scene.nodes[0].local.scale, Vec3(2));
    EXPECT_EQ(warnings_with(scene, "size of \"ball\" is animated"), 1);
    scene = Animated().add("scale", {0, 1}, {2, 2, 2, 2, 2, 2}).read();
    EXPECT_EQ(scene.nodes[0].local.scale, Vec3(2));
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfAnimation, ChannelsWithoutEffectAreSkippedWithAWarning) {
    Animated none = Animated().add("translation", {0, 1}, two_points);
    none.channel()["target"].erase("node");
    EXPECT_EQ(warnings_with(none.read(), "animates no node"), 1);
    EXPECT_TRUE(none.read().tracks.node_translation.empty());
    Animated outside = Animated().add("translation", {0, 1}, two_points);
    outside.builder.json["scenes"] = Json::array({{{"nodes", {1}}}});
    EXPECT_EQ(warnings_with(outside.read(), "outside the scene"), 1);
    Animated weights = Animated().add("translation", {0, 1}, two_points);
    weights.channel()["target"]["path"] = "weights";
    EXPECT_EQ(warnings_with(weights.read(), "morph weights"), 1);
    EXPECT_EQ(weights.read().duration_s, 0.0);
}

TEST(GltfAnimation, ChannelsOutOfRangeAreErrors) {
    Animated node = Animated().add("translation", {0, 1}, two_points);
    node.channel()["target"]["node"] = 2;
    EXPECT_EQ(node.error().place(), "test.glb#/animations/0/channels/0/target/node");
    Animated sampler = Animated().add("translation", {0, 1}, two_points);
    sampler.channel()["sampler"] = 1;
    EXPECT_EQ(sampler.error().place(), "test.glb#/animations/0/channels/0/sampler");
    Animated path = Animated().add("translation", {0, 1}, two_points);
    path.channel()["target"]["path"] = "colour";
    EXPECT_THAT(path.error().what(), HasSubstr("\"colour\""));
}

TEST(GltfAnimation, WrongTimesAndCountsAreErrors) {
    EXPECT_THAT(Animated().add("translation", {1, 0}, two_points).error().what(),
                HasSubstr("must not decrease"));
    EXPECT_THAT(Animated().add("translation", {-1, 0}, two_points).error().what(),
                HasSubstr("between 0 and"));
    EXPECT_THAT(Animated().add("translation", {0, 1e9F}, two_points).error().what(),
                HasSubstr("between 0 and"));
    EXPECT_THAT(Animated().add("translation", {0, std::nanf("")}, two_points).error().what(),
                HasSubstr("not a finite"));
    EXPECT_THAT(Animated().add("translation", {}, {}).error().what(), HasSubstr("without keys"));
    EXPECT_THAT(Animated().add("translation", {0, 1, 2}, two_points).error().what(),
                HasSubstr("3 values for 3 keys"));
    EXPECT_THAT(Animated().add("translation", {0, 1}, two_points, "CUBICSPLINE").error().what(),
                HasSubstr("6 values for 2 keys"));
    EXPECT_THAT(Animated().add("translation", {0, 1}, two_points, "BEZIER").error().what(),
                HasSubstr("\"BEZIER\""));
}

TEST(GltfAnimation, FindsTheFrameRateOfBlendersKeys) {
    for (const double rate : {24.0, 25.0, 30.0, 48.0, 50.0, 60.0}) {
        std::vector<double> times;
        for (int frame = 0; frame <= 500; ++frame) times.push_back(double{static_cast<float>(frame / rate)});
        EXPECT_EQ(gltf::frame_rate_of(times).frames_per_second, rate);
        EXPECT_TRUE(gltf::frame_rate_of(times).keys_on_frames);
    }
    EXPECT_EQ(gltf::frame_rate_of({0, 1, 7}).frames_per_second, 24.0);
    EXPECT_EQ(gltf::frame_rate_of({}).frames_per_second, 24.0);
    EXPECT_EQ(gltf::frame_rate_of({0.1234, 0.777}).frames_per_second, 24.0);
    EXPECT_FALSE(gltf::frame_rate_of({0.1234, 0.777}).keys_on_frames);
}

TEST(GltfAnimation, KeysLieOnFramesToTheLastBit) {
    // 1/24 in single precision is a little more than 1/24: a jump there would come one frame late.
    const Scene scene = Animated().add("translation", {0, 1.0F / 24}, two_points, "STEP").read();
    EXPECT_EQ(scene.tracks.node_translation[0].keys.back().time_s, 1.0 / 24);
    const Scene odd = Animated().add("translation", {0, 0.77F}, two_points).read();
    EXPECT_EQ(odd.tracks.node_translation[0].keys.back().time_s, double{0.77F});
}

}  // namespace
}  // namespace afterglow
