#include "solver/scene/gltf_nodes.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

GlbBuilder with_nodes(const Json& nodes) {
    GlbBuilder builder;
    builder.json["nodes"] = nodes;
    return builder;
}

Error nodes_error(const Json& nodes) {
    return error_of([&] { with_nodes(nodes).read(); });
}

std::vector<std::string> names_of(const Scene& scene) {
    std::vector<std::string> names;
    for (const Node& node : scene.nodes) names.push_back(node.name);
    return names;
}

/// translation · rotation · scale, column by column, as a file would store it.
std::vector<double> matrix_of(const Vec3& translation, const Quat& rotation, const Vec3& scale) {
    const glm::mat3 turn = glm::mat3_cast(rotation);
    std::vector<double> out;
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) out.push_back(double{turn[c][r]} * double{scale[c]});
        out.push_back(0);
    }
    for (int r = 0; r < 3; ++r) out.push_back(double{translation[r]});
    out.push_back(1);
    return out;
}

TEST(GltfNodes, ParentsComeBeforeTheirChildren) {
    const Scene scene = with_nodes(Json::array({{{"name", "leaf"}},
                                                {{"name", "middle"}, {"children", {0}}},
                                                {{"name", "root"}, {"children", {1, 3}}},
                                                {{"name", "other"}}}))
                            .read();
    EXPECT_THAT(names_of(scene), ElementsAre("root", "middle", "leaf", "other"));
    EXPECT_EQ(scene.nodes[0].parent, no_index);
    EXPECT_EQ(scene.nodes[1].parent, 0U);
    EXPECT_EQ(scene.nodes[2].parent, 1U);
    EXPECT_EQ(scene.nodes[3].parent, 0U);
}

TEST(GltfNodes, ReadsTheDefaultSceneOrTheFirstOrAllRoots) {
    GlbBuilder builder = with_nodes(Json::array({{{"name", "a"}}, {{"name", "b"}}, Json::object()}));
    EXPECT_THAT(names_of(builder.read()), ElementsAre("a", "b", "node 2"));
    builder.json["scenes"] = Json::array({{{"nodes", {1}}}, {{"nodes", {2, 0}}}});
    EXPECT_THAT(names_of(builder.read()), ElementsAre("b"));
    builder.json["scene"] = 1;
    EXPECT_THAT(names_of(builder.read()), ElementsAre("node 2", "a"));
    builder.json["scene"] = 2;
    EXPECT_EQ(error_of([&] { builder.read(); }).place(), "test.glb#/scene");
}

TEST(GltfNodes, CyclesTwoParentsAndWrongRootsAreErrors) {
    EXPECT_THAT(nodes_error(Json::array({{{"name", "x"}, {"children", {0}}}})).what(),
                HasSubstr("\"x\" is its own ancestor"));
    EXPECT_THAT(nodes_error(Json::array({{{"children", {1}}}, {{"children", {0}}}})).what(),
                HasSubstr("\"node 0\" is its own ancestor"));
    EXPECT_THAT(nodes_error(Json::array({{{"children", {2}}}, {{"children", {2}}}, Json::object()})).what(),
                HasSubstr("test.glb#/nodes/1/children/0: node 2 has two parents"));
    EXPECT_THAT(nodes_error(Json::array({{{"children", {7}}}})).place(), HasSubstr("/nodes/0/children/0"));
    GlbBuilder builder = with_nodes(Json::array({{{"children", {1}}}, Json::object()}));
    builder.json["scenes"] = Json::array({{{"nodes", {1}}}});
    EXPECT_THAT(error_of([&] { builder.read(); }).what(), HasSubstr("it has a parent"));
    builder.json["scenes"] = Json::array({{{"nodes", {0, 0}}}});
    EXPECT_THAT(error_of([&] { builder.read(); }).what(), HasSubstr("listed twice"));
}

TEST(GltfNodes, AChainOfAnyLengthIsFine) {
    Json nodes = Json::array();
    for (int i = 0; i < 20000; ++i) nodes.push_back({{"children", {i + 1}}});
    nodes.push_back(Json::object());
    const Scene scene = with_nodes(nodes).read();
    ASSERT_EQ(scene.nodes.size(), 20001U);
    for (std::size_t i = 1; i < scene.nodes.size(); ++i) EXPECT_EQ(scene.nodes[i].parent, i - 1);
}

TEST(GltfNodes, ReadsTranslationRotationAndScale) {
    const Scene scene =
        with_nodes(
            Json::array({{{"translation", {1, 2, 3}}, {"rotation", {0, 0.6, 0, 0.8}}, {"scale", {4, 5, 6}}}}))
            .read();
    const Transform& local = scene.nodes[0].local;
    EXPECT_EQ(local.translation, Vec3(1, 2, 3));
    EXPECT_EQ(local.scale, Vec3(4, 5, 6));
    EXPECT_NEAR(local.rotation.w, 0.8, 1e-7);
    EXPECT_NEAR(local.rotation.y, 0.6, 1e-7);
    EXPECT_THAT(nodes_error(Json::array({{{"rotation", {0, 0, 0, 0}}}})).place(),
                HasSubstr("/nodes/0/rotation"));
    EXPECT_THAT(nodes_error(Json::array({{{"translation", {0, 1e39, 0}}}})).place(),
                HasSubstr("/translation"));
}

TEST(GltfNodes, MatricesTakenApartGiveTheSameMatrixBack) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> share(-1, 1);
    for (int round = 0; round < 200; ++round) {
        const Quat rotation =
            glm::normalize(Quat(share(random), share(random), share(random), share(random)));
        const Vec3 translation(9 * share(random), share(random), share(random));
        Vec3 scale;
        for (int c = 0; c < 3; ++c)
            scale[c] = std::exp(3 * share(random)) * (share(random) < 0 ? -1.0F : 1.0F);
        const auto matrix = matrix_of(translation, rotation, scale);
        const Json place = 0;
        const Transform apart = gltf::decomposed(matrix, {place, "t"});
        EXPECT_EQ(apart.translation, translation);
        const auto again = matrix_of(apart.translation, apart.rotation, apart.scale);
        // Largest entry e^3 ≈ 20; some ten roundings of single precision.
        for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(again[i], matrix[i], 3e-5) << "entry " << i;
    }
}

TEST(GltfNodes, MatricesThatAreNoRigidMotionWithScaleAreErrors) {
    const auto matrix_error = [](std::size_t entry, double value) {
        std::vector<double> matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        matrix[entry] = value;
        return nodes_error(Json::array({{{"name", "m"}, {"matrix", matrix}}}));
    };
    EXPECT_THAT(matrix_error(4, 0.5).what(), HasSubstr("test.glb#/nodes/0/matrix: \"m\": the matrix shears"));
    EXPECT_THAT(matrix_error(5, 0).what(), HasSubstr("flattens space"));
    EXPECT_THAT(matrix_error(3, 0.1).what(), HasSubstr("last row"));
    EXPECT_THAT(matrix_error(15, 2).what(), HasSubstr("last row"));
    EXPECT_THAT(nodes_error(Json::array({{{"matrix", {1, 2}}}})).what(), HasSubstr("expected 16 numbers"));
}

TEST(GltfNodes, ReferencesOutOfRangeAreErrors) {
    EXPECT_EQ(nodes_error(Json::array({{{"mesh", 0}}})).place(), "test.glb#/nodes/0/mesh");
    EXPECT_EQ(nodes_error(Json::array({{{"camera", 2}}})).place(), "test.glb#/nodes/0/camera");
    const Json light = {{"KHR_lights_punctual", {{"light", 0}}}};
    EXPECT_THAT(nodes_error(Json::array({{{"extensions", light}}})).place(),
                HasSubstr("/KHR_lights_punctual/light"));
}

}  // namespace
}  // namespace afterglow
