#include "solver/scene/load.h"

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>

#include "solver/base/file.h"
#include "solver/scene/world.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::filesystem::path data = AFTERGLOW_TEST_DATA;

/// Frame numbers of the keys; times in the file are single precision.
std::vector<int> key_frames(const Body& body) {
    std::vector<int> out;
    for (const auto& key : body.path.keys) out.push_back(static_cast<int>(std::lround(key.time_s * 24)));
    return out;
}

TEST(FormatOf, GoesByTheEndingInAnyCase) {
    EXPECT_EQ(format_of("a/room.glb"), SceneFormat::glb);
    EXPECT_EQ(format_of("ROOM.GLTF"), SceneFormat::gltf);
    EXPECT_EQ(format_of("room.v2.Obj"), SceneFormat::obj);
    EXPECT_EQ(format_of("room.json"), SceneFormat::json);
}

TEST(FormatOf, NamesTheEndingsItReads) {
    for (const char* name : {"room.blend", "room", ".glb", ""}) {
        try {
            format_of(name);
            ADD_FAILURE() << name << " accepted";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::unsupported);
            EXPECT_THAT(e.what(), HasSubstr(".glb, .gltf, .obj or .json"));
        }
    }
}

TEST(LoadScene, FindsTheMotionSegmentsOfTheLivingRoom) {
    const World world = assemble(load_scene(data / "living-room.glb"));
    ASSERT_EQ(world.bodies.size(), 4U);
    EXPECT_EQ(world.bodies[1].name, "walker");
    EXPECT_THAT(key_frames(world.bodies[1]), ElementsAre(0, 40, 96));
    EXPECT_EQ(world.bodies[2].name, "visitor");
    EXPECT_THAT(key_frames(world.bodies[2]), ElementsAre(0, 60, 96));
    EXPECT_EQ(world.bodies[3].name, "robot");
    EXPECT_THAT(key_frames(world.bodies[3]), ElementsAre(0, 30, 31, 96)) << "it stops for one frame";
    EXPECT_EQ(world.bodies[3].path.at(30 / 24.0), world.bodies[3].path.at(30.5 / 24.0));
    EXPECT_EQ(world.duration_s, 4);
}

TEST(LoadScene, KeepsThePathWithinTheToleranceOfTheFile) {
    LoadConfig exact;
    exact.collinear_tolerance_m = 0;
    const Scene fine = load_scene(data / "living-room.glb", exact);
    const World coarse = assemble(load_scene(data / "living-room.glb"));
    for (std::size_t actor = 0; actor < 3; ++actor)
        for (int frame = 0; frame <= 96; ++frame) {
            const Vec3 expected = value_at(fine.tracks.node_translation[actor], frame / 24.0);
            const Vec3 found = coarse.bodies[actor + 1].path.at(frame / 24.0).translation;
            EXPECT_LT(glm::length(found - expected), 1e-4F);
        }
}

TEST(LoadScene, FindsTheMotionSegmentsOfTheCornellBlock) {
    const World world = assemble(load_scene(data / "cornell-slide.glb"));
    ASSERT_EQ(world.bodies.size(), 2U);
    EXPECT_EQ(world.bodies[1].name, "short_block");
    EXPECT_THAT(key_frames(world.bodies[1]), ElementsAre(0, 24, 48));
    EXPECT_EQ(world.cameras.size(), 1U);
}

TEST(LoadScene, NamesAFileThatIsNotThere) {
    try {
        load_scene(data / "missing.glb");
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::not_found);
        EXPECT_THAT(e.place(), HasSubstr("missing.glb"));
    }
}

TEST(LoadScene, TakesTheBackgroundFromTheSettings) {
    LoadConfig config;
    config.background = Rgb(1, 2, 3);
    EXPECT_EQ(load_scene(data / "cornell-slide.glb", config).background, Rgb(1, 2, 3));
    config.background = Rgb(-1, 0, 0);
    EXPECT_THROW(load_scene(data / "cornell-slide.glb", config), Error);
}

TEST(ReadScene, GivesTheSameAsTheFile) {
    const Scene from_file = load_scene(data / "cornell-slide.glb");
    const Scene from_memory = read_scene(read_file(data / "cornell-slide.glb"), SceneFormat::glb, "upload");
    ASSERT_EQ(from_file.meshes.size(), from_memory.meshes.size());
    for (std::size_t m = 0; m < from_file.meshes.size(); ++m)
        EXPECT_EQ(from_file.meshes[m].positions, from_memory.meshes[m].positions);
}

TEST(ReadScene, NamesTheSourceInErrorsOfValidation) {
    const char* empty = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": []}], "scene": 0})";
    try {
        read_scene(empty, SceneFormat::gltf, "upload");
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr("upload"));
    }
}

}  // namespace
}  // namespace afterglow
