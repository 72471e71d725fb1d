#include "solver/scene/json_geometry.h"

#include <gmock/gmock.h>

namespace afterglow {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

const Names materials(std::vector<Material>(1), "material");  // one, named ""

Mesh mesh_of(const std::string& text, double unit = 1) {
    const Json json = parse_json(text, "doc");
    return inline_mesh(JsonView(json, "doc"), materials, unit);
}

std::string refusal(const std::string& text) {
    try {
        mesh_of(text);
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

Vec3 scaled_normal(const Mesh& mesh, const Triangle& triangle) {
    const auto& [a, b, c] = triangle.vertices;
    return 0.5F * glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
}

TEST(InlineMesh, ReadsTriangles) {
    const Mesh mesh = mesh_of(R"({"positions": [[0,0,0],[100,0,0],[0,100,0]], "triangles": [[0,1,2]],
                                  "texture_coordinates": [[0,0],[1,0],[0,1]], "material": ""})",
                              0.01);
    EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
    ASSERT_THAT(mesh.triangles, SizeIs(1));
    EXPECT_EQ(mesh.texture_coordinates[2], Vec2(0, 1));
}

TEST(InlineMesh, MakesBoxesThatFaceOutwards) {
    const Mesh mesh = mesh_of(R"({"box": {"size": [2, 4, 6]}, "material": ""})");
    ASSERT_THAT(mesh.triangles, SizeIs(12));
    double total = 0;
    for (const auto& triangle : mesh.triangles) {
        const Vec3 normal = scaled_normal(mesh, triangle);
        total += static_cast<double>(glm::length(normal));
        EXPECT_GT(glm::dot(normal, mesh.positions[triangle.vertices[0]]), 0);
    }
    EXPECT_DOUBLE_EQ(total, 2 * (2 * 4 + 4 * 6 + 2 * 6));
    for (const auto& p : mesh.positions) EXPECT_EQ(glm::abs(p), Vec3(1, 2, 3));
}

TEST(InlineMesh, MakesQuadsThatFaceUp) {
    const Mesh mesh = mesh_of(R"({"quad": {"size": [2, 3]}, "material": ""})");
    ASSERT_THAT(mesh.triangles, SizeIs(2));
    for (const auto& triangle : mesh.triangles) EXPECT_EQ(scaled_normal(mesh, triangle), Vec3(0, 3, 0));
}

TEST(InlineMesh, NamesThePointerOfErrors) {
    EXPECT_THAT(refusal(R"({"positions": [[0,0,0]], "triangles": [[0,0,1]], "material": ""})"),
                HasSubstr("doc#/triangles/0/2"));
    EXPECT_THAT(refusal(R"({"positions": [[0,0,0]], "triangles": [[0,0,-1]], "material": ""})"),
                HasSubstr("doc#/triangles/0/2"));
    EXPECT_THAT(refusal(R"({"positions": [[0,0,0]], "triangles": [[0,0,0.5]], "material": ""})"),
                HasSubstr("doc#/triangles/0/2"));
    EXPECT_THAT(refusal(R"({"positions": [], "triangles": [[0,0,0]], "material": ""})"), HasSubstr("empty"));
    EXPECT_THAT(refusal(R"({"positions": [[0,0]], "triangles": [], "material": ""})"),
                HasSubstr("doc#/positions/0"));
    EXPECT_THAT(
        refusal(R"({"positions": [[0,0,0]], "triangles": [], "texture_coordinates": [], "material": ""})"),
        HasSubstr("doc#/texture_coordinates"));
    EXPECT_THAT(refusal(R"({"box": {"size": [1, 0, 1]}, "material": ""})"), HasSubstr("above 0"));
    EXPECT_THAT(refusal(R"({"box": {"size": [1, 1]}, "material": ""})"), HasSubstr("doc#/box/size"));
    EXPECT_THAT(refusal(R"({"quad": {"size": [1, 1], "colour": 1}, "material": ""})"),
                HasSubstr("doc#/quad/colour"));
    EXPECT_THAT(refusal(R"({"quad": {"size": [1, 1]}, "box": {}, "material": ""})"), HasSubstr("doc#/box"));
    EXPECT_THAT(refusal(R"({"quad": {"size": [1, 1]}})"), HasSubstr("material"));
    EXPECT_THAT(refusal(R"({"quad": {"size": [1, 1]}, "material": "oak"})"), HasSubstr("doc#/material"));
}

}  // namespace
}  // namespace afterglow
