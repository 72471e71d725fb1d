#include "solver/scene/resources.h"

#include <fstream>
#include <unistd.h>

#include <gmock/gmock.h>

#include "solver/base/file.h"
#include "tests/unit/scene/glb_builder.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// outside/secret.txt, and beside it scene/ with files, a folder and links of every kind.
class Resources : public testing::Test {
  protected:
    void SetUp() override {
        base = fs::path(testing::TempDir()) / ("resources_" + std::to_string(::getpid()));
        fs::create_directories(base / "scene/sub");
        fs::create_directories(base / "scene2");
        write_file(base / "secret.txt", "secret");
        write_file(base / "scene2/secret.txt", "secret");
        write_file(base / "scene/a.bin", "inside");
        write_file(base / "scene/sub/with space.bin", "deep");
        fs::create_symlink(base / "secret.txt", base / "scene/link.txt");
        fs::create_directory_symlink(base, base / "scene/linked");
        fs::create_symlink("a.bin", base / "scene/alias.bin");
    }
    void TearDown() override { fs::remove_all(base); }

    [[nodiscard]] Error refusal(const std::string& uri) const {
        return error_of([&] { resources_in(base / "scene")(uri); });
    }

    fs::path base;
};

TEST_F(Resources, ReadsFilesInsideTheFolder) {
    const ResourceReader read = resources_in(base / "scene");
    EXPECT_EQ(read("a.bin"), "inside");
    EXPECT_EQ(read("./sub/../a.bin"), "inside");
    EXPECT_EQ(read("sub/with%20space.bin"), "deep");
    EXPECT_EQ(read("sub/with space.bin"), "deep");
    EXPECT_EQ(read("sub\\with space.bin"), "deep");
    EXPECT_EQ(read("alias.bin"), "inside");
    EXPECT_EQ(resources_in(base / "scene/linked/scene")("a.bin"), "inside");
}

TEST_F(Resources, RefusesEveryWayOut) {
    const std::string absolute = (base / "secret.txt").string();
    const std::vector<std::string> ways_out = {"../secret.txt",
                                               "sub/../../secret.txt",
                                               "%2e%2e/secret.txt",
                                               "%2E%2E%2Fsecret.txt",
                                               "..\\secret.txt",
                                               "..%5csecret.txt",
                                               "../scene2/secret.txt",
                                               "..",
                                               "../../../etc/passwd",
                                               absolute,
                                               "file://" + absolute,
                                               "FILE:" + absolute,
                                               "http://127.0.0.1/secret.txt",
                                               "/%2e/" + absolute,
                                               "%2F" + absolute,
                                               "file%3A%2F%2F" + absolute,
                                               "link.txt",
                                               "linked/secret.txt",
                                               "linked/scene2/secret.txt",
                                               "C:/secret.txt",
                                               "//host/share"};
    for (const std::string& uri : ways_out) {
        const Error error = refusal(uri);
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input) << uri;
        EXPECT_THAT(error.what(), HasSubstr(in_quotes(uri)));
    }
}

TEST_F(Resources, RefusesWhatNamesNoFile) {
    EXPECT_EQ(refusal("").kind(), ErrorKind::invalid_input);
    EXPECT_EQ(refusal("a%00.bin").kind(), ErrorKind::invalid_input);
    EXPECT_EQ(refusal("a%2").kind(), ErrorKind::invalid_input);
    EXPECT_EQ(refusal("a%zz").kind(), ErrorKind::invalid_input);
    EXPECT_EQ(refusal(".").kind(), ErrorKind::invalid_input);
    EXPECT_EQ(refusal("sub").kind(), ErrorKind::io);
    EXPECT_EQ(refusal("none.bin").kind(), ErrorKind::not_found);
    EXPECT_THAT(refusal("none.bin").what(), HasSubstr("\"none.bin\""));
    EXPECT_NE(refusal(std::string(100000, 'x')).kind(), ErrorKind::cancelled);
}

TEST_F(Resources, LimitsTheSize) {
    EXPECT_EQ(resources_in(base / "scene", 6)("a.bin"), "inside");
    EXPECT_EQ(error_of([&] { resources_in(base / "scene", 5)("a.bin"); }).kind(), ErrorKind::too_large);
}

TEST_F(Resources, AGltfFileCannotReadOutside) {
    for (const char* uri : {"../secret.txt", "%2e%2e/secret.txt", "link.txt", "file:///etc/passwd",
                            "/etc/passwd", "../../../etc/passwd"}) {
        const std::string text =
            std::string(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1,"uri":")") + uri + R"("}]})";
        const Error error =
            error_of([&] { read_gltf(text, SceneFormat::gltf, "x.gltf", resources_in(base / "scene"), {}); });
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        EXPECT_EQ(error.place(), "x.gltf#/buffers/0/uri");
        EXPECT_THAT(error.what(), HasSubstr(uri));
    }
}

TEST(InQuotes, ShortensAndKeepsToOneLine) {
    EXPECT_EQ(in_quotes("a\nb\x7F"), "\"a?b?\"");
    EXPECT_EQ(in_quotes(std::string(80, 'x')), "\"" + std::string(80, 'x') + "\"");
    // The two-byte character would be cut in half at byte 77.
    EXPECT_EQ(in_quotes(std::string(76, 'x') + "\xC3\xA9" + std::string(9, 'x')),
              "\"" + std::string(76, 'x') + "...\"");
}

}  // namespace
}  // namespace afterglow
