#include <filesystem>

#include <gmock/gmock.h>

#include "solver/base/file.h"
#include "solver/scene/load.h"
#include "solver/scene/world.h"

// The examples of docs/scene-format.md and docs/paths-format.md.

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

const std::filesystem::path examples = std::filesystem::path(AFTERGLOW_TEST_DATA) / "examples";

std::vector<std::string> body_names(const World& world) {
    std::vector<std::string> out;
    for (const auto& body : world.bodies) out.push_back(body.name);
    return out;
}

TEST(Examples, TheSceneLoadsWithoutWarnings) {
    const Scene scene = load_scene(examples / "study.json");
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_EQ(scene.duration_s, 2);
    const World world = assemble(scene);
    EXPECT_THAT(body_names(world), ElementsAre("furniture", "screen"));
    EXPECT_EQ(world.bodies[1].path.at(1).translation, Vec3(-0.5F, 0, 0));
    // Room 12, panel 2, chair 2 + 2 + 2.
    EXPECT_THAT(world.bodies[0].triangles, SizeIs(20));
    EXPECT_THAT(world.cameras, SizeIs(1));
    EXPECT_THAT(world.lights, SizeIs(1));
}

TEST(Examples, ThePathsChangeTheScene) {
    Scene scene = load_scene(examples / "study.json");
    apply_paths(scene, read_file(examples / "study-paths.json"), "study-paths.json");
    EXPECT_EQ(scene.duration_s, 3);
    EXPECT_THAT(scene.warnings, IsEmpty());
    const World world = assemble(scene);
    const Path& screen = world.bodies.at(1).path;
    // Half of a full turn in two seconds, on the way to z = −0.9.
    EXPECT_NEAR(screen.at(2).translation.z, -0.45F, 1e-4F);
    EXPECT_LT(glm::length(screen.at(2).direction(Vec3(1, 0, 0)) - Vec3(-1, 0, 0)), 1e-3F);
    EXPECT_EQ(material_at(world, 1, 2.2).emission, 0.25F * world.materials[1].emission);
    EXPECT_THAT(world.cameras.at(0).path.keys, testing::Not(IsEmpty()));
}

TEST(Examples, TheChairLoadsAlone) {
    LoadConfig config;
    config.background = Rgb(1);
    const Scene scene = load_scene(examples / "chair.obj", config);
    EXPECT_THAT(scene.meshes, SizeIs(2));
    EXPECT_THAT(scene.warnings, SizeIs(1)) << "the default camera";
}

}  // namespace
}  // namespace afterglow
