#include "solver/scene/gltf_reader.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "solver/base/file.h"
#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

Scene sample(const std::string& name) {
    const std::string bytes = read_file(std::string(AFTERGLOW_TEST_DATA) + "/" + name);
    return read_gltf(bytes, SceneFormat::glb, name, {}, {});
}

std::size_t triangles_in(const Scene& scene) {
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
    return count;
}

const Material& material(const Scene& scene, const std::string& name) {
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&](const Material& m) { return m.name == name; });
    EXPECT_NE(found, scene.materials.end()) << name;
    return found == scene.materials.end() ? scene.materials.front() : *found;
}

void expect_near(const Rgb& value, const Rgb& expected) {
    // Numbers of a dozen digits in the file, single precision here.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], 1e-5F);
}

TEST(GltfReader, ReadsTheCornellBox) {
    const Scene scene = sample("cornell-slide.glb");
    EXPECT_EQ(scene.name, "cornell-slide.glb");
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.nodes.size(), 9U);
    EXPECT_EQ(scene.nodes[6].name, "short_block");
    EXPECT_EQ(scene.nodes[8].name, "camera");
    // Six quadrilaterals and two boxes.
    EXPECT_EQ(triangles_in(scene), 6U * 2 + 2 * 12);
    expect_near(material(scene, "white").reflectance, Rgb(0.73F));
    expect_near(material(scene, "lamp").reflectance, Rgb(0));
    expect_near(material(scene, "lamp").emission, Rgb(17, 12.0000003F, 4.0F));
    ASSERT_EQ(scene.cameras.size(), 1U);
    EXPECT_NEAR(scene.cameras[0].vertical_angle, 0.68604881F, 1e-7F);
    EXPECT_EQ(scene.nodes[8].camera, 0U);
    EXPECT_EQ(scene.nodes[8].local.translation, Vec3(-2.78F, 2.73F, 8));
    ASSERT_EQ(scene.tracks.node_translation.size(), 1U);
    EXPECT_EQ(scene.tracks.node_translation[0].target, 6U);
    EXPECT_EQ(scene.tracks.node_translation[0].keys.size(), 49U);
    EXPECT_EQ(scene.duration_s, 2.0);
    EXPECT_EQ(scene.frames_per_second, 24.0);
}

TEST(GltfReader, ReadsTheLivingRoom) {
    const Scene scene = sample("living-room.glb");
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.nodes.size(), 21U);
    EXPECT_EQ(scene.materials.size(), 11U);
    expect_near(material(scene, "light_panel_a").emission, Rgb(9));
    expect_near(material(scene, "light_panel_b").emission, Rgb(7, 6.02F, 4.62F));
    expect_near(material(scene, "oak").reflectance, Rgb(0.42F, 0.30F, 0.19F));
    EXPECT_EQ(triangles_in(scene), 700U);
    ASSERT_EQ(scene.tracks.node_translation.size(), 3U);
    for (const auto& track : scene.tracks.node_translation) {
        EXPECT_EQ(track.keys.size(), 97U);
        for (std::size_t i = 0; i < track.keys.size(); ++i)
            EXPECT_EQ(track.keys[i].time_s, static_cast<double>(i) / 24);
    }
    EXPECT_EQ(scene.duration_s, 4.0);
    EXPECT_NEAR(scene.cameras[0].vertical_angle, 1.08210409F, 1e-7F);
}

TEST(GltfReader, ABinaryFileUnderTheOtherNameSaysSo) {
    const std::string bytes = glb_of(R"({"asset":{"version":"2.0"}})", "");
    EXPECT_EQ(error_of([&] { read_gltf(bytes, SceneFormat::gltf, "x.gltf", {}, {}); }).kind(),
              ErrorKind::invalid_input);
    EXPECT_EQ(error_of([&] { read_gltf("{}", SceneFormat::glb, "x.glb", {}, {}); }).kind(),
              ErrorKind::invalid_input);
}

TEST(GltfReader, EveryTruncationOfASampleIsAnError) {
    const std::string bytes = read_file(std::string(AFTERGLOW_TEST_DATA) + "/cornell-slide.glb");
    for (std::size_t length = 0; length < bytes.size(); length += 101)
        EXPECT_EQ(error_of([&] { read_gltf(bytes.substr(0, length), SceneFormat::glb, "x", {}, {}); }).kind(),
                  ErrorKind::invalid_input);
}

TEST(GltfReader, TheSameBytesGiveTheSameScene) {
    const Scene a = sample("living-room.glb");
    const Scene b = sample("living-room.glb");
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions);
}

}  // namespace
}  // namespace afterglow
