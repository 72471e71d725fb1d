#include "solver/scene/own_materials.h"

#include <gmock/gmock.h>

#include "tests/unit/scene/test_scenes.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

/// The room, shown a second time by node 2.
Scene twice() {
    Scene scene = room_scene();
    scene.nodes.push_back(scene.nodes[0]);
    scene.nodes.back().name = "other";
    return scene;
}

TEST(OwnMaterials, CopiesNothingWhereNothingIsShared) {
    Scene scene = room_scene();
    EXPECT_THAT(OwnMaterials(scene).of(0), ElementsAre(0, 1));
    EXPECT_THAT(scene.materials, SizeIs(2));
    EXPECT_THAT(scene.meshes, SizeIs(1));
}

TEST(OwnMaterials, CopiesASharedMeshAndItsMaterials) {
    Scene scene = twice();
    const std::vector<Triangle> before = scene.meshes[0].triangles;
    OwnMaterials own(scene);
    EXPECT_THAT(own.of(2), ElementsAre(2, 3));
    EXPECT_EQ(scene.nodes[2].mesh, 1U);
    EXPECT_EQ(scene.nodes[0].mesh, 0U);
    EXPECT_EQ(scene.materials[3].name, "lamp of other");
    EXPECT_EQ(scene.materials[3].emission, scene.materials[1].emission);
    for (std::size_t t = 0; t < before.size(); ++t) {
        EXPECT_EQ(scene.meshes[0].triangles[t].material, before[t].material);
        EXPECT_EQ(scene.meshes[1].triangles[t].material, before[t].material + 2);
    }
    EXPECT_THAT(own.of(2), ElementsAre(2, 3)) << "its own by now";
    EXPECT_THAT(own.of(0), ElementsAre(0, 1)) << "the last one to use them keeps them";
    EXPECT_THAT(scene.materials, SizeIs(4));
}

TEST(OwnMaterials, CopiesOnlyTheMaterialThatIsShared) {
    Scene scene = room_scene();
    Mesh panel = scene.meshes[0];
    panel.triangles.resize(2);  // the lamp's
    scene.meshes.push_back(panel);
    Node node;
    node.name = "panel";
    node.mesh = 1;
    scene.nodes.push_back(node);
    EXPECT_THAT(OwnMaterials(scene).of(0), ElementsAre(0, 2));
    EXPECT_THAT(scene.materials, SizeIs(3));
}

TEST(OwnMaterials, KeepsTheTracksOfTheOriginals) {
    Scene scene = twice();
    scene.tracks.material_emission.push_back({1, {{0, 1.0F}, {1, 0.0F}}});
    OwnMaterials(scene).of(2);
    ASSERT_THAT(scene.tracks.material_emission, SizeIs(2));
    EXPECT_EQ(scene.tracks.material_emission[1].target, 3U);
    EXPECT_THAT(scene.tracks.material_emission[1].keys, SizeIs(2));
}

TEST(OwnMaterials, AreNoneForANodeWithoutAMesh) {
    Scene scene = room_scene();
    EXPECT_THAT(OwnMaterials(scene).of(1), SizeIs(0));
}

}  // namespace
}  // namespace afterglow
