#include "solver/scene/obj_reader.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <unistd.h>

#include <gmock/gmock.h>

#include "solver/scene/load.h"

namespace afterglow {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

using Files = std::map<std::string, std::string>;

Scene read(const std::string& text, const Files& files = {}, const LoadConfig& config = {}) {
    const ResourceReader reader = [&](const std::string& uri) {
        const auto file = files.find(uri);
        if (file == files.end()) throw Error(ErrorKind::not_found, uri, "no such file");
        return file->second;
    };
    return read_obj(text, "room.obj", reader, config);
}

std::string refusal(const std::string& text, const Files& files = {}) {
    try {
        read(text, files);
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ReadObj, ReadsEveryFormOfFace) {
    const Scene scene = read(square +
                             "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
                             "f 1 2 3\nf 1/1 2/2 3/3\nf 1//1 2//1 3//1\nf 1/1/1 2/2/1 3/3/1\nf -4 -3 -2\n"
                             "f -4/-3 -3/-2 -2/-1\nf 1 2 3 4\n");
    ASSERT_THAT(scene.meshes, SizeIs(1));
    const Mesh& mesh = scene.meshes[0];
    ASSERT_THAT(mesh.triangles, SizeIs(8));
    for (std::size_t t = 0; t < 7; ++t) {
        EXPECT_EQ(mesh.positions[mesh.triangles[t].vertices[0]], Vec3(0, 0, 0));
        EXPECT_EQ(mesh.positions[mesh.triangles[t].vertices[1]], Vec3(1, 0, 0));
        EXPECT_EQ(mesh.positions[mesh.triangles[t].vertices[2]], Vec3(1, 1, 0));
    }
    EXPECT_THAT(mesh.positions, SizeIs(3 + 3 + 1)) << "shared where position and coordinates agree";
}

TEST(ReadObj, TurnsTextureCoordinatesUpsideDown) {
    const Scene scene = read(square + "vt 0.25 0.125 0\nvt 0.5\nf 1/1 2/1 3/2\n");
    EXPECT_EQ(scene.meshes[0].texture_coordinates[0], Vec2(0.25F, 0.875F));
    EXPECT_EQ(scene.meshes[0].texture_coordinates[2], Vec2(0.5F, 1.0F));
    EXPECT_THAT(read(square + "f 1 2 3").meshes[0].texture_coordinates, IsEmpty());
}

TEST(ReadObj, MakesNodesOfObjectsAndGroups) {
    const Scene scene = read(
        square + "f 1 2 3\no chair\ng leg front\nf 1 2 3\ng seat\nf 1 2 3\ng empty\ng leg front\nf 2 3 4\n");
    std::vector<std::string> names;
    for (const auto& node : scene.nodes) names.push_back(node.name);
    EXPECT_THAT(names, ElementsAre("default", "leg front", "seat"));
    EXPECT_THAT(scene.meshes[1].triangles, SizeIs(2)) << "a group taken up again";
}

TEST(ReadObj, AppliesUnitAndUpAxis) {
    LoadConfig config;
    config.obj_unit_m = 0.01;
    config.obj_up = UpAxis::z;
    const Scene scene = read("v 100 200 300\nv 0 0 0\nv 100 0 0\nf 1 2 3\n", {}, config);
    EXPECT_EQ(scene.meshes[0].positions[0], Vec3(1, 3, -2));
    config.obj_unit_m = 0;
    EXPECT_THROW(read(square, {}, config), Error);
}

TEST(ReadObj, ReadsCrlfContinuationAndVertexColours) {
    const Scene scene = read("v 0 0 0 1 0.5 0.5\r\nv 1 0 0\r\nv 1 1 \\\r\n 0\r\nf 1 \\\r\n2 3\r\n");
    ASSERT_THAT(scene.meshes, SizeIs(1));
    EXPECT_EQ(scene.meshes[0].positions[2], Vec3(1, 1, 0));
}

TEST(ReadObj, CutsConcavePolygonsInside) {
    const Scene scene = read("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 3 4 5 1 2\n");
    double sum = 0;
    const Mesh& mesh = scene.meshes[0];
    for (const auto& triangle : mesh.triangles)
        sum += 0.5 * static_cast<double>(glm::length(glm::cross(
                         mesh.positions[triangle.vertices[1]] - mesh.positions[triangle.vertices[0]],
                         mesh.positions[triangle.vertices[2]] - mesh.positions[triangle.vertices[0]])));
    EXPECT_NEAR(sum, 4 - 1.5, 1e-6) << "the square less the notch";
}

TEST(ReadObj, NamesTheLineOfEveryError) {
    EXPECT_THAT(refusal(square + "f 1 2 5\n"), AllOf(HasSubstr("room.obj:5"), HasSubstr("vertex 5")));
    EXPECT_THAT(refusal(square + "f 1 2 0\n"), HasSubstr("room.obj:5"));
    EXPECT_THAT(refusal(square + "f 1 2 -5\n"), HasSubstr("room.obj:5"));
    EXPECT_THAT(refusal(square + "f 1 2 99999999999999999999\n"), HasSubstr("room.obj:5"));
    EXPECT_THAT(refusal(square + "f 1/1 2/1 3/1\n"), HasSubstr("texture vertex 1 does not exist"));
    EXPECT_THAT(refusal(square + "f 1 2\n"), HasSubstr("three vertices"));
    EXPECT_THAT(refusal(square + "f 1 2 x\n"), HasSubstr("\"x\""));
    EXPECT_THAT(refusal("v 1 2\n"), HasSubstr("room.obj:1"));
    EXPECT_THAT(refusal("v nan 0 0\n"), HasSubstr("not finite"));
    EXPECT_THAT(refusal("\nv 1 inf 0\n"), HasSubstr("room.obj:2"));
    EXPECT_THAT(refusal("glTF\x02 binary"), HasSubstr("unknown statement"));
    EXPECT_THAT(refusal("usemtl\n"), HasSubstr("names no material"));
}

TEST(ReadObj, LeavesOutWhatIsNoPolygonWithOneWarning) {
    const Scene scene = read(square + "l 1 2\nl 2 3\np 1\nvn 0 0 1\ns off\nf 1 2 3\n");
    ASSERT_THAT(scene.warnings, SizeIs(1));
    EXPECT_THAT(scene.warnings[0].message, HasSubstr("l, p"));
}

TEST(ReadObj, TakesUnknownMaterialsAsGreyWithOneWarningEach) {
    const Scene scene = read(square + "usemtl oak\nf 1 2 3\nusemtl oak\nf 1 2 4\n");
    ASSERT_THAT(scene.materials, SizeIs(1));
    EXPECT_EQ(scene.materials[0].name, "oak");
    ASSERT_THAT(scene.warnings, SizeIs(1));
    EXPECT_EQ(scene.warnings[0].place, "room.obj:5");
}

TEST(ReadObj, ReadsLibrariesWithSeveralOrSpacedNames) {
    const Files files{{"a.mtl", "newmtl a\nKd 0.1 0.2 0.3\n"},
                      {"b.mtl", "newmtl b\nKe 5\n"},
                      {"my room.mtl", "newmtl c\n"}};
    const Scene scene =
        read("mtllib a.mtl b.mtl\nmtllib my room.mtl\n" + square + "usemtl b\nf 1 2 3\n", files);
    ASSERT_THAT(scene.materials, SizeIs(3));
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(scene.materials[1].emission, Rgb(5));
    EXPECT_EQ(scene.meshes[0].triangles[0].material, 1U);
}

TEST(ReadObj, NamesTheLineOfALibraryThatCannotBeRead) {
    EXPECT_THAT(refusal("\nmtllib gone.mtl\n"), AllOf(HasSubstr("room.obj:2"), HasSubstr("gone.mtl")));
    EXPECT_THROW(read_obj("mtllib a.mtl\n", "upload", {}, {}), Error) << "a scene sent by itself";
}

TEST(LoadScene, OfAnObjReadsNothingOutsideItsFolder) {
    const auto folder =
        std::filesystem::path(testing::TempDir()) / ("obj_reader_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder / "inner");
    const auto put = [&](const char* name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
    };
    put("outside.mtl", "newmtl lamp\nKe 1 1 1\n");
    put("inner/climbs.obj", "mtllib ../outside.mtl\n" + square + "usemtl lamp\nf 1 2 3\n");
    put("inner/texture.mtl", "newmtl lamp\nKe 1 1 1\nmap_Kd ../../../../../etc/passwd\n");
    put("inner/texture.obj", "mtllib texture.mtl\n" + square + "usemtl lamp\nf 1 2 3\n");
    put("inner/good.mtl", "newmtl lamp\nKe 1 1 1\n");
    put("inner/good.obj", "mtllib good.mtl\n" + square + "usemtl lamp\nf 1 2 3\n");
    for (const auto& [file, place] :
         {std::pair{"inner/climbs.obj", "climbs.obj:1"}, std::pair{"inner/texture.obj", "texture.mtl:3"}}) {
        try {
            load_scene(folder / file);
            ADD_FAILURE() << file << " accepted";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::invalid_input);
            EXPECT_THAT(e.what(), AllOf(HasSubstr(place), HasSubstr("outside")));
        }
    }
    const Scene scene = load_scene(folder / "inner/good.obj");
    EXPECT_THAT(scene.cameras, SizeIs(1)) << "a default one";
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace afterglow
