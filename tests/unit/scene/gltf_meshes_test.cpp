#include "solver/scene/gltf_meshes.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

using Corners = std::array<Index, 3>;

std::vector<Corners> corners_of(const Mesh& mesh) {
    std::vector<Corners> out;
    for (const Triangle& triangle : mesh.triangles) out.push_back(triangle.vertices);
    return out;
}

/// Five points in a zigzag, without indices.
GlbBuilder zigzag(int mode, std::size_t points) {
    GlbBuilder builder;
    std::vector<float> positions;
    for (std::size_t i = 0; i < points; ++i) {
        const auto x = static_cast<float>(i);
        positions.insert(positions.end(), {x, static_cast<float>(i % 2), 0});
    }
    builder.add_mesh({{"attributes", {{"POSITION", builder.add_vec3(positions)}}}, {"mode", mode}});
    return builder;
}

TEST(GltfMeshes, TrianglesWithAndWithoutIndices) {
    EXPECT_EQ(corners_of(zigzag(4, 6).read().meshes[0]), (std::vector<Corners>{{0, 1, 2}, {3, 4, 5}}));
    GlbBuilder builder = zigzag(4, 4);
    builder.json["meshes"][0]["primitives"][0]["indices"] = builder.add_indices({2, 1, 0, 3, 2, 1});
    const Scene scene = builder.read();
    EXPECT_EQ(corners_of(scene.meshes[0]), (std::vector<Corners>{{2, 1, 0}, {3, 2, 1}}));
    EXPECT_EQ(scene.meshes[0].positions[3], Vec3(3, 1, 0));
    EXPECT_TRUE(scene.meshes[0].texture_coordinates.empty());
}

TEST(GltfMeshes, StripsAndFansKeepTheirFacing) {
    const Scene strip = zigzag(5, 6).read();
    EXPECT_EQ(corners_of(strip.meshes[0]),
              (std::vector<Corners>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}}));
    for (const Triangle& t : strip.meshes[0].triangles) {
        const auto& p = strip.meshes[0].positions;
        const Vec3 normal =
            glm::cross(p[t.vertices[1]] - p[t.vertices[0]], p[t.vertices[2]] - p[t.vertices[0]]);
        EXPECT_LT(normal.z, 0);
    }
    EXPECT_EQ(corners_of(zigzag(6, 5).read().meshes[0]),
              (std::vector<Corners>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
    EXPECT_TRUE(zigzag(5, 2).read().meshes[0].triangles.empty());
}

TEST(GltfMeshes, PointsAndLinesAreLeftOutWithAWarning) {
    for (const int mode : {0, 1, 2, 3}) {
        const Scene scene = zigzag(mode, 6).read();
        EXPECT_TRUE(scene.meshes[0].triangles.empty());
        EXPECT_EQ(warnings_with(scene, "no area"), 1);
    }
    EXPECT_THAT(error_of([] { zigzag(7, 3).read(); }).place(), HasSubstr("/primitives/0/mode"));
}

TEST(GltfMeshes, PrimitivesOfAMeshAreJoined) {
    GlbBuilder builder = zigzag(4, 3);
    builder.json["materials"] = Json::array({{{"name", "a"}}, {{"name", "b"}}});
    Json primitive = {{"attributes", {{"POSITION", builder.add_vec3({9, 0, 0, 9, 1, 0, 9, 0, 1})}}},
                      {"material", 1},
                      {"indices", builder.add_indices({2, 0, 1})}};
    builder.json["meshes"][0]["primitives"][0]["material"] = 0;
    builder.json["meshes"][0]["primitives"].push_back(primitive);
    const Mesh mesh = builder.read().meshes[0];
    ASSERT_EQ(corners_of(mesh), (std::vector<Corners>{{0, 1, 2}, {5, 3, 4}}));
    EXPECT_EQ(mesh.triangles[0].material, 0U);
    EXPECT_EQ(mesh.triangles[1].material, 1U);
    EXPECT_EQ(mesh.positions[5], Vec3(9, 0, 1));
}

TEST(GltfMeshes, QuantisedPositions) {
    GlbBuilder builder;
    builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int accessor =
        builder.add(std::vector<std::int16_t>{0, 0, 0, 0, 100, 0, 0, 0, 0, 200, 0, 0}, 5122, "VEC3", 4);
    builder.json["bufferViews"][0]["byteStride"] = 8;
    builder.add_mesh({{"attributes", {{"POSITION", accessor}}}});
    const Scene scene = builder.read();
    ASSERT_EQ(scene.meshes[0].positions.size(), 3U);
    EXPECT_EQ(scene.meshes[0].positions[2], Vec3(0, 200, 0));
}

TEST(GltfMeshes, IndicesOutOfRangeNameTheirPlace) {
    for (const std::uint16_t bad : {std::uint16_t{3}, std::uint16_t{65535}}) {
        GlbBuilder builder = zigzag(4, 3);
        builder.json["meshes"][0]["primitives"][0]["indices"] = builder.add_indices({0, 1, bad});
        const Error error = error_of([&] { builder.read(); });
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        EXPECT_EQ(error.place(), "test.glb#/meshes/0/primitives/0/indices");
        EXPECT_THAT(error.what(), HasSubstr("index " + std::to_string(bad) + " at position 2"));
    }
}

TEST(GltfMeshes, IncompleteTrianglesAreErrors) {
    EXPECT_THAT(error_of([] { zigzag(4, 4).read(); }).what(), HasSubstr("4 corners"));
}

TEST(GltfMeshes, TheSameBytesOverAndOverCannotFillTheMemory) {
    GlbBuilder builder;
    const int zeros = builder.add_accessor({{"componentType", 5126}, {"type", "VEC3"}, {"count", 999999}});
    for (int i = 0; i < 20; ++i) builder.add_mesh({{"attributes", {{"POSITION", zeros}}}});
    EXPECT_EQ(error_of([&] { builder.read(); }).kind(), ErrorKind::too_large);
}

TEST(GltfMeshes, WhatIsLeftOutIsSaidOnce) {
    GlbBuilder builder = zigzag(4, 3);
    auto& primitive = builder.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] = 0;
    primitive["attributes"]["JOINTS_0"] = 0;
    primitive["targets"] = Json::array();
    builder.json["meshes"].push_back(builder.json["meshes"][0]);
    const Scene scene = builder.read();
    EXPECT_EQ(warnings_with(scene, "vertex colours"), 1);
    EXPECT_EQ(warnings_with(scene, "rest pose"), 1);
    EXPECT_EQ(warnings_with(scene, "base shape"), 1);
    EXPECT_EQ(scene.meshes[1].triangles.size(), 1U);
}

TEST(GltfMeshes, AnyIndexedMeshComesThroughUnchanged) {
    std::mt19937 random(1);
    for (int round = 0; round < 20; ++round) {
        const std::size_t vertices = 3 + random() % 50;
        std::vector<float> positions(3 * vertices);
        for (float& p : positions) p = static_cast<float>(random() % 1000) - 500.0F;
        std::vector<std::uint16_t> indices(3 * (random() % 40));
        for (auto& index : indices) index = static_cast<std::uint16_t>(random() % vertices);
        GlbBuilder builder;
        const int position_accessor = builder.add_vec3(positions);
        builder.add_mesh(
            {{"attributes", {{"POSITION", position_accessor}}}, {"indices", builder.add_indices(indices)}});
        const Mesh mesh = builder.read().meshes[0];
        ASSERT_EQ(mesh.triangles.size(), indices.size() / 3);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const Index vertex = mesh.triangles[i / 3].vertices[i % 3];
            EXPECT_EQ(vertex, indices[i]);
            EXPECT_EQ(mesh.positions[vertex].y, positions[3 * vertex + 1]);
        }
    }
}

}  // namespace
}  // namespace afterglow
