#include "client/scene_files.h"

#include <fstream>
#include <unistd.h>

#include <gmock/gmock.h>

#include "client/content_hash.h"

namespace afterglow::client {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

class SceneFilesTest : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(base_ / "scene/sub"); }
    void TearDown() override { fs::remove_all(base_); }

    void write(const std::string& name, const std::string& content) const {
        std::ofstream(base_ / name, std::ios::binary) << content;
    }
    [[nodiscard]] std::vector<std::string> names(const std::string& scene, const std::string& content) const {
        std::vector<std::string> names;
        for (const auto& [name, bytes] : collect_scene_files(base_ / "scene" / scene, content))
            names.push_back(name);
        return names;
    }

    fs::path base_ = fs::path(testing::TempDir()) / ("scene_files_" + std::to_string(::getpid()));
};

TEST_F(SceneFilesTest, AGltfBringsItsBuffersAndPictures) {
    write("scene/a b.bin", "1");
    write("scene/sub/wood.png", "2");
    const std::string text = R"({"buffers": [{"uri": "a%20b.bin"}, {"uri": "data:;base64,AA=="}],
        "images": [{"uri": "sub\\wood.png"}, {"uri": "missing.png"}]})";
    EXPECT_THAT(names("room.gltf", text), ElementsAre("a b.bin", "room.gltf", "sub/wood.png"));
    std::string glb = "glTF" + std::string(8, '\0');
    glb += {static_cast<char>(text.size()), 0, 0, 0};
    EXPECT_THAT(names("room.glb", glb + "JSON" + text), ElementsAre("a b.bin", "room.glb", "sub/wood.png"));
}

TEST_F(SceneFilesTest, ModelsBringTheirOwnFiles) {
    write("scene/sub/chair.obj", "mtllib chair.mtl\nv 0 0 0\n");
    write("scene/sub/chair.mtl", "newmtl a\nmap_Kd -s 2 2 oak wood.png\r\nmap_Ke glow.png\n");
    write("scene/sub/oak wood.png", "");
    write("scene/sub/glow.png", "");
    EXPECT_THAT(
        names("room.json", R"({"nodes": [{"geometry": {"file": "sub/chair.obj"}}]})"),
        ElementsAre("room.json", "sub/chair.mtl", "sub/chair.obj", "sub/glow.png", "sub/oak wood.png"));
    write("scene/sub/chair.mtl", "newmtl a\nmap_Kd oak wood.png\n");
    EXPECT_THAT(names("room.json", R"({"nodes": [{"geometry": {"file": "sub/chair.obj"}}]})"),
                ElementsAre("room.json", "sub/chair.mtl", "sub/chair.obj", "sub/oak wood.png"));
}

TEST_F(SceneFilesTest, NothingOutsideTheFolderIsTaken) {
    write("secret", "1");
    fs::create_symlink(base_ / "secret", base_ / "scene/link");
    fs::create_directory_symlink(base_, base_ / "scene/up");
    for (const std::string uri : {"../secret", "/etc/hostname", "link", "up/secret", "sub/../../secret",
                                  "%2e%2e/secret", "sub", ".", "file:///etc/hostname", ""})
        EXPECT_THAT(names("a.gltf", R"({"images": [{"uri": ")" + uri + R"("}]})"), ElementsAre("a.gltf"))
            << uri;
}

TEST_F(SceneFilesTest, WhatCannotBeReadIsLeftToTheServer) {
    EXPECT_THAT(names("a.gltf", "{"), ElementsAre("a.gltf"));
    EXPECT_THAT(names("a.glb", "glTF"), ElementsAre("a.glb"));
    EXPECT_THAT(names("a.obj", "mtllib\nmtllib none.mtl\n"), ElementsAre("a.obj"));
}

TEST(ContentHash, IsSha256) {
    // FIPS 180-4, the examples for one block and for none.
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

}  // namespace
}  // namespace afterglow::client
