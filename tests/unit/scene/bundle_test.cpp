#include "solver/scene/bundle.h"

#include <random>

#include <gmock/gmock.h>

#include "solver/base/file.h"
#include "solver/scene/load.h"
#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

const std::filesystem::path examples = std::filesystem::path(AFTERGLOW_TEST_DATA) / "examples";

TEST(Bundle, ComesBackAsItWas) {
    const Bundle bundle{"a/scene.gltf",
                        {{"a/scene.gltf", "{}"}, {"a/b.bin", std::string_view("\0\n", 2)}, {"c", ""}}};
    const std::string bytes = pack(bundle);
    const Bundle back = unpack(bytes, "upload");
    EXPECT_EQ(back.main, bundle.main);
    EXPECT_EQ(back.files, bundle.files);
    EXPECT_EQ(pack(back), bytes);
}

TEST(Bundle, AnyOtherBytesAreRefused) {
    const std::string whole = pack({"s.obj", {{"s.obj", "v 0 0 0\n"}, {"t", "12"}}});
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_THROW(unpack(whole.substr(0, length), "x"), Error) << length;
    EXPECT_THROW(unpack(whole + "1", "x"), Error);
    std::mt19937 random(1);
    for (int trial = 0; trial < 2000; ++trial) {
        std::string bytes = whole;
        bytes[random() % bytes.size()] = static_cast<char>(random());
        try {
            const Bundle bundle = unpack(bytes, "x");
            EXPECT_TRUE(bundle.files.contains(bundle.main));
        } catch (const Error&) {
            continue;
        }
    }
}

TEST(Bundle, OnlyPathsInsideItsFolderArePlain) {
    for (const char* name : {"a", "a.b", "a/b/c.png", "...", "a..b", ".hidden", "with blank", "\xC3\xA4.png"})
        EXPECT_TRUE(is_plain_path(name)) << name;
    for (const char* name : {"", "/a", "a/", "a//b", ".", "..", "../a", "a/../b", "a/..", "./a", "a\\b",
                             "C:a", "a\nb", "a\x7F", "\xFF"})
        EXPECT_FALSE(is_plain_path(name)) << name;
    EXPECT_FALSE(is_plain_path(std::string_view("a\0b", 3)));
    EXPECT_TRUE(is_plain_path(std::string(500, 'a')));
    EXPECT_FALSE(is_plain_path(std::string(501, 'a')));
}

TEST(Bundle, FilesAreFoundBesideTheScene) {
    const Bundle bundle{"x/scene.gltf", {{"x/scene.gltf", ""}, {"x/t/a b.png", "deep"}, {"above", "secret"}}};
    const auto read = resources_of(bundle);
    EXPECT_EQ(read("t/a%20b.png"), "deep");
    EXPECT_EQ(read("./t/../t\\a b.png"), "deep");
    EXPECT_EQ(error_of([&] { read("t/none.png"); }).kind(), ErrorKind::not_found);
    EXPECT_EQ(error_of([&] { read("above"); }).kind(), ErrorKind::not_found);
    for (const char* uri : {"../above", "/above", "file:///above", "", "%2e%2e/above"})
        EXPECT_EQ(error_of([&] { read(uri); }).kind(), ErrorKind::invalid_input) << uri;
}

TEST(Bundle, IsReadAsTheFilesInAFolderAre) {
    const std::string study = read_file(examples / "study.json");
    const std::string obj = read_file(examples / "chair.obj");
    const std::string mtl = read_file(examples / "chair.mtl");
    const std::string bytes =
        pack({"in/study.json", {{"in/study.json", study}, {"in/chair.obj", obj}, {"in/chair.mtl", mtl}}});
    const Scene bundled = read_scene(bytes, SceneFormat::bundle, "upload");
    const Scene loaded = load_scene(examples / "study.json");
    ASSERT_EQ(bundled.meshes.size(), loaded.meshes.size());
    for (std::size_t m = 0; m < loaded.meshes.size(); ++m)
        EXPECT_EQ(bundled.meshes[m].positions, loaded.meshes[m].positions);
    EXPECT_EQ(bundled.materials.size(), loaded.materials.size());
    EXPECT_EQ(bundled.warnings.size(), loaded.warnings.size());
}

TEST(Bundle, ErrorsNameTheSceneInIt) {
    const std::string bytes =
        pack({"in/study.json", {{"in/study.json", read_file(examples / "study.json")}}});
    const Error error = error_of([&] { read_scene(bytes, SceneFormat::bundle, "upload"); });
    EXPECT_EQ(error.kind(), ErrorKind::not_found);
    EXPECT_THAT(error.place(), HasSubstr("in/study.json#/nodes/2/geometry/file"));
    const std::string notes = pack({"notes.txt", {{"notes.txt", ""}}});
    EXPECT_EQ(error_of([&] { read_scene(notes, SceneFormat::bundle, "upload"); }).kind(),
              ErrorKind::unsupported);
}

}  // namespace
}  // namespace afterglow
