#include "solver/scene/json_reader.h"

#include <map>

#include <gmock/gmock.h>

#include "solver/base/file.h"
#include "solver/base/pixels.h"
#include "solver/scene/world.h"

namespace afterglow {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

const std::map<std::string, std::string> files{
    {"parts/chair.obj",
     "mtllib chair.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng seat\nusemtl oak\nf 1 2 3\ng leg\nusemtl iron\nf 1 2 "
     "3\n"},
    {"parts/chair.mtl", "newmtl oak\nKd .4 .3 .2\nnewmtl iron\nKd .1 .1 .1\n"},
    {"red.png", encode_png(1, 1, {255, 0, 0})},
    {"inner.json", "{}"},
};

std::string fetch(const std::string& uri) {
    if (uri == "block.glb") return read_file(std::string(AFTERGLOW_TEST_DATA) + "/cornell-slide.glb");
    const auto file = files.find(uri);
    if (file == files.end()) throw Error(ErrorKind::not_found, uri, "no such file");
    return file->second;
}

Scene read(const std::string& members) {
    return read_json_scene(R"({"afterglow": 1, )" + members + "}", "room.json", fetch, {});
}

std::string refusal(const std::string& members) {
    try {
        read(members);
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

std::vector<std::string> node_names(const Scene& scene) {
    std::vector<std::string> out;
    for (const auto& node : scene.nodes) out.push_back(node.name);
    return out;
}

TEST(ReadJsonScene, ReadsMaterials) {
    const Scene scene = read(R"("materials": [
        {"name": "a", "reflectance": [0.1, 0.2, 0.3], "emission": 4, "shines": "both"},
        {"name": "b", "texture": "red.png"}, {"name": "c", "texture": "red.png", "reflectance": 0.5}, {"name": "d"}])");
    ASSERT_THAT(scene.materials, SizeIs(4));
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(scene.materials[0].emission, Rgb(4));
    EXPECT_EQ(scene.materials[0].shines, Material::Shines::both);
    EXPECT_THAT(scene.textures, SizeIs(1)) << "read once";
    EXPECT_EQ(scene.materials[1].reflectance, Rgb(0.99F)) << "the picture's colour";
    EXPECT_EQ(scene.materials[3].reflectance, Rgb(0.8F));
}

TEST(ReadJsonScene, ReadsTheHierarchyInItsUnits) {
    const Scene scene =
        read(R"("name": "flat", "units": "cm", "frames_per_second": 30, "duration_s": 2, "background": 1,
        "materials": [{"name": "m"}],
        "nodes": [{"name": "a", "translation": [100, 0, 0], "rotation": [0, 2, 0, 90], "scale": 2},
                  {"name": "b", "parent": "a", "scale": [1, 2, 3],
                   "geometry": {"box": {"size": [100, 100, 100]}, "material": "m"}}])");
    EXPECT_EQ(scene.name, "flat");
    EXPECT_EQ(scene.frames_per_second, 30);
    EXPECT_EQ(scene.background, Rgb(1));
    ASSERT_THAT(scene.nodes, SizeIs(2));
    EXPECT_EQ(scene.nodes[0].local.translation, Vec3(1, 0, 0));
    EXPECT_EQ(scene.nodes[0].local.scale, Vec3(2));
    EXPECT_LT(glm::length(scene.nodes[0].local.rotation * Vec3(1, 0, 0) - Vec3(0, 0, -1)), 1e-6F);
    EXPECT_EQ(scene.nodes[1].parent, 0U);
    EXPECT_EQ(glm::abs(scene.meshes[scene.nodes[1].mesh].positions[0]), Vec3(0.5F));
}

TEST(ReadJsonScene, PlacesFilesWithTheirMaterials) {
    const Scene scene = read(R"("materials": [{"name": "oak", "reflectance": 0.7}],
        "nodes": [{"name": "one", "geometry": {"file": "parts/chair.obj"}},
                  {"name": "two", "geometry": {"file": "parts/chair.obj", "node": "leg"}}])");
    EXPECT_THAT(node_names(scene), ElementsAre("one", "one/seat", "one/leg", "two", "two/leg"));
    EXPECT_EQ(scene.nodes[4].parent, 3U);
    EXPECT_EQ(scene.nodes[4].mesh, scene.nodes[2].mesh) << "a file comes once";
    EXPECT_THAT(scene.materials, SizeIs(2)) << "the document's oak takes the place of the file's";
    EXPECT_EQ(scene.materials[scene.meshes[scene.nodes[1].mesh].triangles[0].material].reflectance,
              Rgb(0.7F));
    EXPECT_EQ(scene.materials[scene.meshes[scene.nodes[2].mesh].triangles[0].material].reflectance,
              Rgb(0.1F));
}

TEST(ReadJsonScene, PlacesAnimatedFiles) {
    Scene scene =
        read(R"("nodes": [{"name": "set", "translation": [0, 0, -9], "geometry": {"file": "block.glb"}},
                                    {"name": "copy", "geometry": {"file": "block.glb", "node": "short_block"}}])");
    EXPECT_THAT(scene.tracks.node_translation, SizeIs(2));
    EXPECT_TRUE(scene.cameras.empty());
    validate(scene);
    const World world = assemble(scene);
    ASSERT_THAT(world.bodies, SizeIs(3));
    EXPECT_EQ(world.bodies[1].name, "set/short_block");
    EXPECT_FLOAT_EQ(world.bodies[1].path.at(1).translation.z, -9);
    EXPECT_FLOAT_EQ(world.bodies[2].path.at(1).translation.x, -0.7F);
}

TEST(ReadJsonScene, PlacesCamerasAndLights) {
    const Scene scene = read(R"(
        "cameras": [{"name": "front", "position": [0, 1, 5], "look_at": [0, 1, 0], "vertical_angle_deg": 90},
                    {"name": "top", "position": [0, 9, 0], "look_at": [0, 0, 0], "up": [0, 0, -1]}],
        "lights": [{"name": "bulb", "kind": "point", "intensity": 5, "position": [0, 2, 0]},
                   {"name": "spot", "kind": "spot", "intensity": [1, 2, 3], "position": [1, 2, 0], "look_at": [1, 0, 0],
                    "inner_angle_deg": 10, "outer_angle_deg": 30},
                   {"name": "sun", "kind": "directional", "intensity": 9, "direction": [0, -1, 0]}])");
    ASSERT_THAT(scene.nodes, SizeIs(5));
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_angle, pi / 2);
    EXPECT_LT(glm::length(scene.nodes[0].local.rotation * Vec3(0, 0, -1) - Vec3(0, 0, -1)), 1e-6F);
    EXPECT_LT(glm::length(scene.nodes[1].local.rotation * Vec3(0, 1, 0) - Vec3(0, 0, -1)), 1e-6F);
    EXPECT_EQ(scene.lights[1].intensity, Rgb(1, 2, 3));
    EXPECT_FLOAT_EQ(scene.lights[1].outer_cone_angle, pi / 6);
    for (const std::size_t node : {std::size_t{3}, std::size_t{4}})
        EXPECT_LT(glm::length(scene.nodes[node].local.rotation * Vec3(0, 0, -1) - Vec3(0, -1, 0)), 1e-6F);
    EXPECT_EQ(scene.lights[2].kind, Light::Kind::directional);
}

TEST(ReadJsonScene, ReadsTracksInItsUnits) {
    const Scene scene = read(R"("units": "cm", "time_unit": "frame", "frames_per_second": 10,
        "nodes": [{"name": "a"}], "tracks": [{"node": "a", "translation": [[0, 0,0,0], [10, 100,0,0]]}])");
    ASSERT_THAT(scene.tracks.node_translation, SizeIs(1));
    EXPECT_EQ(value_at(scene.tracks.node_translation[0], 1), Vec3(1, 0, 0));
}

TEST(ReadJsonScene, NamesThePointerOfEveryError) {
    EXPECT_THAT(refusal(R"("nods": [])"), HasSubstr("room.json#/nods: unknown field"));
    EXPECT_THAT(refusal(R"("units": "mile")"), HasSubstr("#/units"));
    EXPECT_THAT(refusal(R"("frames_per_second": 0)"), HasSubstr("#/frames_per_second"));
    EXPECT_THAT(refusal(R"("background": [1, 2])"), HasSubstr("#/background"));
    EXPECT_THAT(refusal(R"("materials": [{"name": "a", "color": 1}])"), HasSubstr("#/materials/0/color"));
    EXPECT_THAT(refusal(R"("materials": [{}])"), HasSubstr("\"name\" is missing"));
    EXPECT_THAT(refusal(R"("materials": [{"name": "a"}, {"name": "a"}])"), HasSubstr("#/materials/1/name"));
    EXPECT_THAT(refusal(R"("materials": [{"name": "a", "reflectance": -1}])"),
                HasSubstr("#/materials/0/reflectance"));
    EXPECT_THAT(refusal(R"("materials": [{"name": "a", "shines": "back"}])"),
                HasSubstr("#/materials/0/shines"));
    EXPECT_THAT(refusal(R"("nodes": [{"name": "a", "parent": "b"}, {"name": "b"}])"),
                AllOf(HasSubstr("#/nodes/0/parent"), HasSubstr("before their children")));
    EXPECT_THAT(refusal(R"("nodes": [{"name": "a"}, {"name": "a"}, {"name": "b", "parent": "a"}])"),
                HasSubstr("more than one node"));
    EXPECT_THAT(refusal(R"("nodes": [{"name": "a", "rotation": [0, 0, 0, 1]}])"), HasSubstr("axis"));
    EXPECT_THAT(refusal(R"("nodes": [{"name": "a", "geometry": {}}])"), HasSubstr("#/nodes/0/geometry"));
    EXPECT_THAT(refusal(R"("cameras": [{"name": "a", "position": [0,0,0], "look_at": [0,0,0]}])"),
                HasSubstr("direction"));
    EXPECT_THAT(refusal(R"("cameras": [{"name": "a", "position": [0,0,0]}])"), HasSubstr("look_at"));
    EXPECT_THAT(refusal(R"("lights": [{"name": "a", "kind": "area", "intensity": 1}])"),
                HasSubstr("#/lights/0/kind"));
    EXPECT_THAT(refusal(R"("lights": [{"name": "a", "kind": "point", "intensity": 1}])"),
                HasSubstr("position"));
    EXPECT_THAT(refusal(R"("tracks": [{"node": "a", "translation": [[0,0,0,0]]}])"),
                HasSubstr("#/tracks/0/node"));
}

TEST(ReadJsonScene, NamesTheReferenceOfAFileThatFails) {
    const auto of_file = [](const std::string& file) {
        return refusal(R"("nodes": [{"name": "a", "geometry": {"file": ")" + file + R"("}}])");
    };
    EXPECT_THAT(of_file("gone.obj"), HasSubstr("room.json#/nodes/0/geometry/file"));
    EXPECT_THAT(of_file("inner.json"), HasSubstr("only .glb, .gltf and .obj"));
    EXPECT_THAT(of_file("red.png"), HasSubstr("#/nodes/0/geometry/file"));
    EXPECT_THAT(
        refusal(R"("nodes": [{"name": "a", "geometry": {"file": "parts/chair.obj", "node": "set"}}])"),
        AllOf(HasSubstr("#/nodes/0/geometry/node"), HasSubstr("\"seat\"")));
    EXPECT_THROW(
        read_json_scene(R"({"afterglow": 1, "nodes": [{"name": "a", "geometry": {"file": "a.obj"}}]})",
                        "upload", {}, {}),
        Error);
}

TEST(ReadJsonScene, RejectsOtherVersionsAndOtherJson) {
    EXPECT_THROW(read_json_scene("{}", "x", {}, {}), Error);
    EXPECT_THROW(read_json_scene(R"({"afterglow": 2})", "x", {}, {}), Error);
    EXPECT_THROW(read_json_scene(R"({"afterglow_paths": 1, "tracks": []})", "x", {}, {}), Error);
    EXPECT_THROW(read_json_scene("[1]", "x", {}, {}), Error);
    EXPECT_THROW(read_json_scene(std::string(200'000, '['), "x", {}, {}), Error);
}

}  // namespace
}  // namespace afterglow
