#include "solver/scene/gltf_lights.h"

#include <gmock/gmock.h>

#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

GlbBuilder with_light(const Json& light, const char* generator = "a modeller") {
    GlbBuilder builder;
    builder.json["asset"]["generator"] = generator;
    builder.json["extensions"] = {{"KHR_lights_punctual", {{"lights", Json::array({light})}}}};
    builder.json["nodes"] =
        Json::array({{{"name", "bulb"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}});
    return builder;
}

GlbBuilder with_camera(const Json& camera) {
    GlbBuilder builder;
    builder.json["cameras"] = Json::array({camera});
    builder.json["nodes"] = Json::array({{{"name", "eye"}, {"camera", 0}}});
    return builder;
}

TEST(GltfLights, ReadsEveryKind) {
    Scene scene = with_light({{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 4}}).read();
    ASSERT_EQ(scene.lights.size(), 1U);
    EXPECT_EQ(scene.lights[0].kind, Light::Kind::point);
    EXPECT_EQ(scene.lights[0].intensity, Rgb(4, 2, 0));
    EXPECT_EQ(scene.nodes[0].light, 0U);
    EXPECT_TRUE(scene.warnings.empty());
    scene = with_light({{"type", "directional"}, {"name", "sun"}}).read();
    EXPECT_EQ(scene.lights[0].kind, Light::Kind::directional);
    EXPECT_EQ(scene.lights[0].intensity, Rgb(1));
    EXPECT_EQ(scene.lights[0].name, "sun");
    scene =
        with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}).read();
    EXPECT_EQ(scene.lights[0].kind, Light::Kind::spot);
    EXPECT_EQ(scene.lights[0].inner_cone_angle, 0.25F);
    EXPECT_EQ(scene.lights[0].outer_cone_angle, 0.5F);
}

TEST(GltfLights, DividesByLumensPerWattWhereAsked) {
    const Json light = {{"type", "point"}, {"intensity", 6830}};
    const char* blender = "Khronos glTF Blender I/O v3.6.6";
    const auto intensity = [&](const char* generator, LumenScale scale) {
        LoadConfig config;
        config.lumen_scale = scale;
        const Scene scene = with_light(light, generator).read(config);
        EXPECT_EQ(warnings_with(scene, "683"), scene.lights[0].intensity.r < 100 ? 1 : 0);
        return scene.lights[0].intensity.r;
    };
    EXPECT_FLOAT_EQ(intensity(blender, LumenScale::automatic), 10);
    EXPECT_FLOAT_EQ(intensity("other", LumenScale::automatic), 6830);
    EXPECT_FLOAT_EQ(intensity(blender, LumenScale::keep), 6830);
    EXPECT_FLOAT_EQ(intensity("other", LumenScale::divide), 10);
}

TEST(GltfLights, WrongLightsAreErrors) {
    const auto place = [](const Json& light) { return error_of([&] { with_light(light).read(); }).place(); };
    const std::string at = "test.glb#/extensions/KHR_lights_punctual/lights/0";
    EXPECT_EQ(place({{"type", "area"}}), at + "/type");
    EXPECT_EQ(place({{"type", "point"}, {"intensity", -1}}), at);
    EXPECT_EQ(place({{"type", "point"}, {"intensity", 1e300}}), at);
    EXPECT_EQ(place({{"type", "spot"}}), at);
    EXPECT_EQ(place({{"type", "spot"}, {"spot", {{"outerConeAngle", 2}}}}), at + "/spot");
    EXPECT_EQ(place({{"type", "spot"}, {"spot", {{"innerConeAngle", 1}}}}), at + "/spot");
}

TEST(GltfCameras, KeepsTheVerticalAngle) {
    const Scene scene =
        with_camera(
            {{"type", "perspective"}, {"name", "main"}, {"perspective", {{"yfov", 0.75}, {"znear", 0.1}}}})
            .read();
    ASSERT_EQ(scene.cameras.size(), 1U);
    EXPECT_EQ(scene.cameras[0].vertical_angle, 0.75F);
    EXPECT_EQ(scene.cameras[0].name, "main");
    EXPECT_EQ(scene.nodes[0].camera, 0U);
}

TEST(GltfCameras, OrthographicOnesAreLeftOutWithAWarning) {
    GlbBuilder builder = with_camera({{"type", "orthographic"}, {"name", "plan"}});
    builder.json["cameras"].push_back({{"type", "perspective"}, {"perspective", {{"yfov", 1}}}});
    builder.json["nodes"].push_back({{"camera", 1}});
    const Scene scene = builder.read();
    EXPECT_EQ(warnings_with(scene, "\"plan\" is orthographic"), 1);
    EXPECT_EQ(scene.nodes[0].camera, no_index);
    EXPECT_EQ(scene.nodes[1].camera, 0U);
    EXPECT_EQ(scene.cameras.size(), 1U);
}

TEST(GltfCameras, AnglesOutOfRangeAreErrors) {
    for (const double angle : {0.0, -1.0, 3.2, 1e300})
        EXPECT_THAT(error_of([&] {
                        with_camera({{"type", "perspective"}, {"perspective", {{"yfov", angle}}}}).read();
                    }).place(),
                    HasSubstr("/cameras/0/perspective/yfov"));
    EXPECT_THAT(error_of([] { with_camera({{"type", "fisheye"}}).read(); }).what(), HasSubstr("\"fisheye\""));
}

}  // namespace
}  // namespace afterglow
