#include "solver/scene/furniture.h"

#include <gmock/gmock.h>

namespace afterglow {
namespace {

/// Nodes with one triangle each, at places along x.
Scene row_of(const std::vector<std::pair<std::string, float>>& nodes) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].emission = Rgb(1);
    scene.meshes.push_back(
        {"triangle", {Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {}, {Triangle{{0, 1, 2}, 0}}});
    scene.cameras.push_back({"camera", 0.7F});
    Node camera;
    camera.name = "camera";
    camera.camera = 0;
    scene.nodes.push_back(camera);
    for (const auto& [name, x] : nodes) {
        Node node;
        node.name = name;
        node.mesh = 0;
        node.local.translation = Vec3(x, 0, 0);
        scene.nodes.push_back(node);
    }
    return scene;
}

void expect_same(const World& a, const World& b) {
    const Body &one = a.bodies[furniture], &two = b.bodies[furniture];
    EXPECT_EQ(one.positions, two.positions);
    EXPECT_EQ(one.texture_coordinates, two.texture_coordinates);
    ASSERT_EQ(one.triangles.size(), two.triangles.size());
    for (std::size_t t = 0; t < one.triangles.size(); ++t)
        EXPECT_EQ(one.triangles[t].vertices, two.triangles[t].vertices);
    ASSERT_EQ(a.pieces.size(), b.pieces.size());
    for (std::size_t k = 0; k < a.pieces.size(); ++k) {
        EXPECT_EQ(a.pieces[k].name, b.pieces[k].name);
        EXPECT_EQ(a.pieces[k].first_triangle, b.pieces[k].first_triangle);
        EXPECT_EQ(a.pieces[k].triangles, b.pieces[k].triangles);
    }
}

TEST(Furniture, ChangedIsAsAssembledSo) {
    World world = assemble(row_of({{"a", 0}, {"b", 2}, {"c", 4}}));
    EXPECT_EQ(bounds_of(world, 1).low, Vec3(2, 0, 0));
    EXPECT_EQ(bounds_of(world, 1).high, Vec3(3, 1, 0));
    move_piece(world, 1, {Vec3(0.5F, 0, 0), Quat(1, 0, 0, 0)});
    expect_same(world, assemble(row_of({{"a", 0}, {"b", 2.5F}, {"c", 4}})));
    remove_piece(world, 0);
    expect_same(world, assemble(row_of({{"b", 2.5F}, {"c", 4}})));
    Body object;
    object.name = "d";
    object.positions = {Vec3(8, 0, 0), Vec3(9, 0, 0), Vec3(8, 1, 0)};
    object.triangles = {Triangle{{0, 1, 2}, 0}, Triangle{{0, 1, 1}, 0}};
    add_piece(world, object);
    expect_same(world, assemble(row_of({{"b", 2.5F}, {"c", 4}, {"d", 8}})));
}

}  // namespace
}  // namespace afterglow
