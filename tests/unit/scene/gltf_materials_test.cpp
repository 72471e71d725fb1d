#include "solver/scene/gltf_materials.h"

#include <gmock/gmock.h>

#include "solver/base/pixels.h"
#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

GlbBuilder with_material(const Json& material) {
    GlbBuilder builder;
    builder.json["materials"] = Json::array({material});
    builder.add_triangle(0);
    return builder;
}

/// A textured triangle; the picture is 2 × 1, red and blue.
GlbBuilder textured(const Json& texture_info, const std::vector<float>& uv = {0.25F, 0, 0.75F, 0, 0.25F, 1}) {
    GlbBuilder builder = with_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", texture_info}}}});
    const int view = builder.add_view(encode_png(2, 1, {255, 0, 0, 0, 0, 255}));
    builder.json["images"] = Json::array({{{"bufferView", view}, {"mimeType", "image/png"}}});
    builder.json["textures"] = Json::array({{{"source", 0}}});
    builder.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = builder.add_vec2(uv);
    return builder;
}

TEST(GltfMaterials, ReadsColourEmissionAndSides) {
    const Scene scene =
        with_material(
            {{"name", "lamp"},
             {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.125, 1}}, {"metallicFactor", 0}}},
             {"emissiveFactor", {1, 0.5, 0.25}},
             {"doubleSided", true},
             {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}})
            .read();
    ASSERT_EQ(scene.materials.size(), 1U);
    const Material& lamp = scene.materials[0];
    EXPECT_EQ(lamp.name, "lamp");
    EXPECT_EQ(lamp.reflectance, Rgb(0.5F, 0.25F, 0.125F));
    EXPECT_EQ(lamp.emission, Rgb(8, 4, 2));
    EXPECT_EQ(lamp.shines, Material::Shines::both);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMaterials, DefaultsAreTheSpecifications) {
    const Scene scene = with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}).read();
    EXPECT_EQ(scene.materials[0].name, "material 0");
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(1));
    EXPECT_EQ(scene.materials[0].emission, Rgb(0));
    EXPECT_EQ(scene.materials[0].shines, Material::Shines::front);
}

TEST(GltfMaterials, NoMaterialReflectsEightTenthsWithOneWarning) {
    GlbBuilder builder;
    builder.add_triangle();
    builder.add_triangle();
    const Scene scene = builder.read();
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.8F));
    EXPECT_EQ(warnings_with(scene, "without a material"), 1);
}

TEST(GltfMaterials, WhatIsNotDiffuseGetsAWarningThatSaysSo) {
    const auto warned = [](const Json& material, const std::string& trait) {
        const Scene scene = with_material(material).read();
        EXPECT_EQ(scene.meshes[0].triangles.size(), 1U) << trait;
        return warnings_with(scene, "\"m\" is not diffuse (" + trait + ")");
    };
    EXPECT_EQ(warned({{"name", "m"}, {"pbrMetallicRoughness", {{"metallicFactor", 1}}}}, "metallic"), 1);
    EXPECT_EQ(warned({{"name", "m"}}, "metallic"), 1);
    const Json plain = {{"metallicFactor", 0}};
    for (const auto& [extension, trait] :
         {std::pair("KHR_materials_unlit", "unlit"), std::pair("KHR_materials_clearcoat", "clear-coated"),
          std::pair("KHR_materials_sheen", "with sheen")})
        EXPECT_EQ(warned({{"name", "m"},
                          {"pbrMetallicRoughness", plain},
                          {"extensions", {{extension, Json::object()}}}},
                         trait),
                  1);
    EXPECT_EQ(warned({{"name", "m"}, {"pbrMetallicRoughness", plain}, {"alphaMode", "BLEND"}},
                     "transparent in parts"),
              1);
    // Present in every file that Blender writes, and without effect on diffuse light.
    const Json specular = {{"KHR_materials_specular", Json::object()}, {"KHR_materials_ior", Json::object()}};
    EXPECT_TRUE(
        with_material({{"pbrMetallicRoughness", plain}, {"extensions", specular}}).read().warnings.empty());
}

/// Triangles left of a material's mesh, which must come with a warning that names the material if there are
/// none.
std::size_t triangles_of(Json material) {
    material["name"] = "pane";
    const Scene scene = with_material(material).read();
    const std::size_t left = scene.meshes[0].triangles.size();
    EXPECT_EQ(warnings_with(scene, "\"pane\""), left == 0 ? 1 : warnings_with(scene, "is not diffuse"));
    return left;
}

TEST(GltfMaterials, TransparentPanesAreOpenings) {
    const auto alpha = [](double value, const char* mode) {
        return Json{{"alphaMode", mode},
                    {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {1, 1, 1, value}}}}};
    };
    EXPECT_EQ(triangles_of(alpha(0.3, "BLEND")), 0U);
    EXPECT_EQ(triangles_of(alpha(0.5, "BLEND")), 1U);
    EXPECT_EQ(triangles_of(alpha(0.3, "MASK")), 0U);
    EXPECT_EQ(triangles_of(alpha(0.7, "MASK")), 1U);
    EXPECT_EQ(triangles_of(alpha(0.0, "OPAQUE")), 1U);
    Json cut = alpha(0.7, "MASK");
    cut["alphaCutoff"] = 0.9;
    EXPECT_EQ(triangles_of(cut), 0U);
    const auto transmission = [](double factor) {
        return Json{{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", factor}}}}}};
    };
    EXPECT_EQ(triangles_of(transmission(1)), 0U);
    EXPECT_EQ(triangles_of(transmission(0.5)), 1U);
}

TEST(GltfMaterials, ATransparentLampStaysALamp) {
    const Scene scene =
        with_material({{"emissiveFactor", {1, 1, 1}},
                       {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}})
            .read();
    EXPECT_EQ(scene.meshes[0].triangles.size(), 1U);
    EXPECT_EQ(scene.materials[0].emission, Rgb(1));
}

TEST(GltfMaterials, ReadsTheTextureOnce) {
    GlbBuilder builder = textured({{"index", 0}});
    builder.json["materials"].push_back(builder.json["materials"][0]);
    builder.json["textures"].push_back({{"source", 0}});
    builder.json["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
    const Scene scene = builder.read();
    ASSERT_EQ(scene.textures.size(), 1U);
    EXPECT_EQ(scene.textures[0].width, 2);
    EXPECT_EQ(scene.materials[0].texture, 0U);
    EXPECT_EQ(scene.materials[1].texture, 0U);
    ASSERT_EQ(scene.meshes[0].texture_coordinates.size(), 3U);
    EXPECT_EQ(scene.textures[0].at(scene.meshes[0].texture_coordinates[0]), Rgb(1, 0, 0));
    EXPECT_EQ(scene.textures[0].at(scene.meshes[0].texture_coordinates[1]), Rgb(0, 0, 1));
}

TEST(GltfMaterials, PicturesMayComeAsDataUrisOrFiles) {
    GlbBuilder builder = textured({{"index", 0}});
    builder.json["images"][0] = {{"uri", "wood.png"}};
    const ResourceReader reader = [](const std::string& uri) {
        EXPECT_EQ(uri, "wood.png");
        return encode_png(3, 1, std::vector<std::uint8_t>(9, 255));
    };
    EXPECT_EQ(read_gltf(builder.glb(), SceneFormat::glb, "t", reader, {}).textures[0].width, 3);
    EXPECT_EQ(error_of([&] { builder.read(); }).place(), "test.glb#/images/0/uri");
    builder.json["images"][0] = {{"uri", "data:image/png;base64,AAAA"}};
    EXPECT_EQ(error_of([&] { builder.read(); }).place(), "test.glb#/images/0");
}

TEST(GltfMaterials, TransformsCoordinates) {
    // A quarter turn: uv (1, 0) goes to offset + (cos, -sin) · 2.
    const Json transform = {{"offset", {0.5, 0.25}}, {"rotation", 1.5707963267948966}, {"scale", {2, 3}}};
    const Scene scene =
        textured({{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}, {1, 0, 0, 1, 0, 0})
            .read();
    const auto& uv = scene.meshes[0].texture_coordinates;
    ASSERT_EQ(uv.size(), 3U);
    EXPECT_NEAR(uv[0].x, 0.5, 1e-6);
    EXPECT_NEAR(uv[0].y, 0.25 - 2, 1e-6);
    EXPECT_NEAR(uv[1].x, 0.5 + 3, 1e-6);
    EXPECT_NEAR(uv[1].y, 0.25, 1e-6);
    EXPECT_EQ(uv[2], Vec2(0.5F, 0.25F));
}

TEST(GltfMaterials, TakesTheCoordinateSetThatTheTextureNames) {
    GlbBuilder builder = textured({{"index", 0}, {"texCoord", 1}});
    EXPECT_EQ(warnings_with(builder.read(), "has no TEXCOORD_1"), 1);
    builder.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        builder.add_vec2({9, 8, 7, 6, 5, 4});
    EXPECT_EQ(builder.read().meshes[0].texture_coordinates[0], Vec2(9, 8));
    builder.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = builder.add_vec2({9, 8});
    EXPECT_THAT(error_of([&] { builder.read(); }).place(), HasSubstr("/attributes/TEXCOORD_1"));
}

TEST(GltfMaterials, SaysWhereClampingIsNotDone) {
    GlbBuilder builder = textured({{"index", 0}});
    builder.json["samplers"] = Json::array({{{"wrapS", 33071}}});
    builder.json["textures"][0]["sampler"] = 0;
    EXPECT_EQ(warnings_with(builder.read(), "clamping"), 0);
    builder.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        builder.add_vec2({0, 0, 2, 0, 0, 1});
    EXPECT_EQ(warnings_with(builder.read(), "clamping"), 1);
}

TEST(GltfMaterials, EmissionByAPictureIsItsMean) {
    GlbBuilder builder = textured({{"index", 0}});
    builder.json["materials"][0]["emissiveTexture"] = {{"index", 0}};
    builder.json["materials"][0]["emissiveFactor"] = {1, 1, 0.5};
    const Scene scene = builder.read();
    EXPECT_EQ(scene.materials[0].emission, Rgb(0.5F, 0, 0.25F));
    EXPECT_EQ(warnings_with(scene, "mean colour"), 1);
    EXPECT_EQ(scene.textures.size(), 1U);
}

TEST(GltfMaterials, WrongValuesNameTheirField) {
    const auto place = [](const Json& material) {
        return error_of([&] { with_material(material).read(); }).place();
    };
    EXPECT_EQ(place({{"emissiveFactor", {1, 1}}}), "test.glb#/materials/0/emissiveFactor");
    EXPECT_EQ(place({{"emissiveFactor", {1, 1, -1}}}), "test.glb#/materials/0/emissiveFactor");
    EXPECT_EQ(place({{"emissiveFactor", {1, 1, 1e39}}}), "test.glb#/materials/0/emissiveFactor");
    EXPECT_EQ(place({{"alphaMode", "GLOW"}}), "test.glb#/materials/0/alphaMode");
    EXPECT_EQ(place({{"pbrMetallicRoughness", {{"metallicFactor", 2}}}}),
              "test.glb#/materials/0/pbrMetallicRoughness/metallicFactor");
    EXPECT_EQ(place({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 5}}}}}}),
              "test.glb#/materials/0/pbrMetallicRoughness/baseColorTexture/index");
}

}  // namespace
}  // namespace afterglow
