#include <gmock/gmock.h>

#include "solver/scene/load.h"
#include "solver/scene/world.h"
#include "tests/unit/scene/test_scenes.h"

namespace afterglow {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;

std::string document(const std::string& tracks, const std::string& more = "") {
    return R"({"afterglow_paths": 1, )" + more + R"("tracks": [)" + tracks + "]}";
}

/// The room as a loaded scene, with a block in it.
Scene scene_with_block() {
    Scene scene = room_scene();
    Mesh block = scene.meshes[0];
    for (auto& p : block.positions) p *= 0.2F;
    for (auto& triangle : block.triangles) triangle.material = 0;
    scene.meshes.push_back(block);
    Node node;
    node.name = "block";
    node.mesh = 1;
    scene.nodes.push_back(node);
    validate(scene);
    return scene;
}

std::string refusal(const std::string& json, ErrorKind kind = ErrorKind::invalid_input) {
    Scene scene = scene_with_block();
    try {
        apply_paths(scene, json, "p.json");
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), kind) << e.what();
        return e.what();
    }
    return "accepted";
}

TEST(ApplyPaths, MovesANode) {
    Scene scene = scene_with_block();
    apply_paths(scene, document(R"({"node": "block", "translation": [[0, 0,0,0], [1, 0.5,0,0], [3, 1.5,0,0]],
                                    "rotation": [[0, 0,1,0, 0], [2, 0,1,0, 90]]})"),
                "p.json");
    EXPECT_EQ(scene.duration_s, 3);
    ASSERT_THAT(scene.tracks.node_translation, SizeIs(1));
    EXPECT_THAT(scene.tracks.node_translation[0].keys, SizeIs(2)) << "collinear keys are merged";
    const World world = assemble(scene);
    ASSERT_THAT(world.bodies, SizeIs(2));
    EXPECT_EQ(world.bodies[1].path.at(1).translation, Vec3(0.5F, 0, 0));
}

TEST(ApplyPaths, CountsTimesInFramesWhereAsked) {
    Scene scene = scene_with_block();
    scene.frames_per_second = 10;
    apply_paths(scene,
                document(R"({"node": "block", "translation": [[0, 0,0,0], [20, 1,0,0]]})",
                         R"("time_unit": "frame", )"),
                "p.json");
    EXPECT_DOUBLE_EQ(scene.duration_s, 2);
}

TEST(ApplyPaths, ReplacesTheTrackOfTheSameProperty) {
    Scene scene = scene_with_block();
    apply_paths(scene, document(R"({"node": "block", "translation": [[0, 0,0,0], [1, 1,0,0]]})"), "p.json");
    apply_paths(scene, document(R"({"node": "block", "translation": [[0, 0,0,0], [1, 0,1,0]]})"), "p.json");
    ASSERT_THAT(scene.tracks.node_translation, SizeIs(1));
    EXPECT_EQ(value_at(scene.tracks.node_translation[0], 1), Vec3(0, 1, 0));
}

TEST(ApplyPaths, ChangesMaterials) {
    Scene scene = scene_with_block();
    apply_paths(scene, document(R"({"material": "lamp", "emission_scale": [[0, 1], [2, 0]]},
                                   {"material": "wall", "reflectance": [[0, 0.1,0.2,0.3], [1, 0.3,0.2,0.1]],
                                    "interpolation": "step"})"),
                "p.json");
    const World world = assemble(scene);
    EXPECT_EQ(material_at(world, 1, 1).emission, Rgb(1.5F));
    EXPECT_EQ(material_at(world, 0, 0.9).reflectance, Rgb(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(material_at(world, 0, 1).reflectance, Rgb(0.3F, 0.2F, 0.1F));
}

TEST(ApplyPaths, ChangesOneNodeAndNothingElse) {
    Scene scene = scene_with_block();
    apply_paths(scene, document(R"({"node": "block", "reflectance": [[0, 0,0,0]]})"), "p.json");
    ASSERT_THAT(scene.materials, SizeIs(3));
    const World world = assemble(scene);
    EXPECT_EQ(material_at(world, 0, 0).reflectance, Rgb(0.5F)) << "the wall as before";
    EXPECT_EQ(material_at(world, 2, 0).reflectance, Rgb(0));
    std::size_t changed = 0;
    for (const auto& triangle : world.bodies[0].triangles) changed += triangle.material == 2;
    EXPECT_EQ(changed, 12U);
}

TEST(ApplyPaths, GivesANodesOwnCopyTheTracksOfItsMaterialInAnyOrder) {
    const std::string node = R"({"node": "block", "reflectance": [[0, 0,0,0]]})";
    const std::string material = R"({"material": "wall", "reflectance": [[0, 0.4,0.4,0.4]]})";
    for (const auto& list : {node + "," + material, material + "," + node}) {
        Scene scene = scene_with_block();
        apply_paths(scene, document(list), "p.json");
        const World world = assemble(scene);
        EXPECT_EQ(material_at(world, 0, 0).reflectance, Rgb(0.4F));
        EXPECT_EQ(material_at(world, 2, 0).reflectance, Rgb(0));
    }
}

TEST(ApplyPaths, AimsACameraAtAMovingPoint) {
    Scene scene = scene_with_block();
    apply_paths(scene, document(R"({"camera": "camera", "look_at": [[0, -1,0,0.5], [2, 1,0,0.5]]},
                                   {"camera": "camera", "position": [[0, 0,0,-0.5], [2, 0,0.5,-0.5]]})"),
                "p.json");
    const World world = assemble(scene);
    ASSERT_THAT(world.cameras, SizeIs(1));
    for (int frame = 0; frame <= 48; ++frame) {
        const auto share = static_cast<float>(frame) / 48;
        const Pose pose = world.cameras[0].path.at(frame / 24.0);
        const Vec3 from(0, 0.5F * share, -0.5F);
        const Vec3 to(-1 + 2 * share, 0, 0.5F);
        // Two merging passes of 1e-4 each.
        EXPECT_LT(glm::length(pose.translation - from), 3e-4F);
        EXPECT_LT(glm::length(pose.direction(Vec3(0, 0, -1)) - glm::normalize(to - from)), 3e-4F) << frame;
    }
}

TEST(ApplyPaths, MovesACameraBelowAnotherNodeInWorldCoordinates) {
    Scene scene = scene_with_block();
    scene.nodes[1].parent = 0;
    scene.nodes[0].local.translation = Vec3(5, 0, 0);
    apply_paths(scene, document(R"({"camera": "camera", "position": [[0, 1,2,3]]})"), "p.json");
    const World world = assemble(scene);
    ASSERT_THAT(world.cameras, SizeIs(1));
    EXPECT_EQ(world.cameras[0].path.at(0).translation, Vec3(1, 2, 3));
}

TEST(ApplyPaths, NamesPointerAndNearNamesOfAnUnknownTarget) {
    EXPECT_THAT(refusal(document(R"({"node": "blok", "translation": [[0, 0,0,0]]})")),
                AllOf(HasSubstr("p.json#/tracks/0/node"), HasSubstr("did you mean \"block\"?")));
    EXPECT_THAT(refusal(document(R"({"material": "lmp", "emission_scale": [[0, 1]]})")),
                HasSubstr("\"lamp\""));
    EXPECT_THAT(refusal(document(R"({"camera": "cam", "position": [[0, 0,0,0]]})")), HasSubstr("\"camera\""));
}

TEST(ApplyPaths, RejectsAnAmbiguousName) {
    Scene scene = scene_with_block();
    scene.nodes[2].name = "room";
    try {
        apply_paths(scene, document(R"({"node": "room", "translation": [[0, 0,0,0]]})"), "p.json");
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), AllOf(HasSubstr("#/tracks/0/node"), HasSubstr("numbers 0 and 2")));
    }
}

TEST(ApplyPaths, RejectsWhatItDoesNotKnow) {
    EXPECT_THAT(refusal("{"), HasSubstr("p.json"));
    EXPECT_THAT(refusal("[]"), HasSubstr("p.json"));
    EXPECT_THAT(refusal(R"({"tracks": []})"), HasSubstr("afterglow_paths"));
    EXPECT_THAT(refusal(R"({"afterglow_paths": 2, "tracks": []})"), HasSubstr("#/afterglow_paths"));
    EXPECT_THAT(refusal(document("", R"("time_unit": "hour", )")), HasSubstr("#/time_unit"));
    EXPECT_THAT(refusal(document("", R"("traks": [], )")), HasSubstr("#/traks: unknown field"));
    EXPECT_THAT(refusal(document(R"({"node": "block", "scale": [[0,1,1,1]]})")),
                HasSubstr("#/tracks/0/scale"));
    EXPECT_THAT(refusal(document(R"({"translation": [[0,1,1,1]]})")), HasSubstr("#/tracks/0"));
    EXPECT_THAT(refusal(document(R"({"node": "block"})")), HasSubstr("says nothing"));
    EXPECT_THAT(refusal(document(R"({"node": "block", "material": "wall", "reflectance": [[0,0,0,0]]})")),
                HasSubstr("#/tracks/0/material"));
    EXPECT_THAT(
        refusal(document(R"({"node": "block", "translation": [[0,0,0,0]], "interpolation": "cubic"})")),
        HasSubstr("cubic"));
    const std::string twice = R"({"node": "block", "translation": [[0,0,0,0]]})";
    EXPECT_THAT(refusal(document(twice + "," + twice)), HasSubstr("#/tracks/1/translation"));
    EXPECT_THAT(refusal(document(R"({"material": "wall", "emission_scale": [[0,1]]})")),
                HasSubstr("does not shine"));
    EXPECT_THAT(refusal(document(R"({"node": "camera", "reflectance": [[0,0,0,0]]})")),
                HasSubstr("no surfaces"));
    EXPECT_THAT(refusal(document(R"({"camera": "camera", "look_at": [[0,0,0,0]]})")),
                HasSubstr("stands in the point"));
}

TEST(ApplyPaths, RejectsWhatMakesTheSceneImpossible) {
    EXPECT_THAT(
        refusal(document(R"({"material": "wall", "reflectance": [[0, 1,1,1]]})"), ErrorKind::cannot_converge),
        HasSubstr("wall"));
    EXPECT_THAT(refusal(document(R"({"material": "lamp", "emission_scale": [[0, 0]]})")),
                HasSubstr("shines"));
    EXPECT_THAT(refusal(document(R"({"node": "block", "translation": [[0,0,0,0], [1e6,1,0,0]]})"),
                        ErrorKind::too_large),
                HasSubstr("million frames"));
    EXPECT_THAT(refusal(document(R"({"camera": "camera", "look_at": [[0,0,0,1], [1e6,1,0,1]]})"),
                        ErrorKind::too_large),
                HasSubstr("million frames"));
    EXPECT_THAT(refusal(std::string(200'000, '['), ErrorKind::too_large), HasSubstr("p.json"));
}

TEST(ApplyPaths, LeavesTheSceneAsItWasAfterAnError) {
    Scene scene = scene_with_block();
    apply_paths(scene, document(R"({"node": "block", "translation": [[0, 0,0,0], [1, 1,0,0]]})"), "p.json");
    const Scene before = scene;
    // Everything in the first three tracks would be fine.
    EXPECT_THROW(apply_paths(scene, document(R"({"node": "block", "translation": [[0, 0,0,0], [9, 2,0,0]],
                                                 "reflectance": [[0, 0,0,0]]},
                                                {"material": "lamp", "emission_scale": [[0, 2]]},
                                                {"camera": "camera", "position": [[0, 0,0,0.5]]},
                                                {"node": "camera", "reflectance": [[0, 0,0,0]]})"),
                             "p.json"),
                 Error);
    EXPECT_EQ(scene.duration_s, before.duration_s);
    EXPECT_EQ(scene.materials.size(), before.materials.size());
    EXPECT_EQ(scene.meshes.size(), before.meshes.size());
    EXPECT_EQ(scene.nodes.size(), before.nodes.size());
    EXPECT_EQ(scene.nodes[2].mesh, before.nodes[2].mesh);
    EXPECT_TRUE(scene.tracks.material_emission.empty());
    EXPECT_TRUE(scene.tracks.material_reflectance.empty());
    ASSERT_THAT(scene.tracks.node_translation, SizeIs(1));
    EXPECT_EQ(value_at(scene.tracks.node_translation[0], 1), Vec3(1, 0, 0));
    EXPECT_EQ(scene.warnings.size(), before.warnings.size());
}

}  // namespace
}  // namespace afterglow
