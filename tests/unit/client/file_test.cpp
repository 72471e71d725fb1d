#include "client/file.h"

#include <fstream>
#include <unistd.h>

#include <gtest/gtest.h>

#include "client/error.h"

namespace afterglow::client {
namespace {

namespace fs = std::filesystem;

class ClientFile : public testing::Test {
  protected:
    ClientFile()
        : folder_(fs::temp_directory_path() / ("afterglow_client_file_" + std::to_string(::getpid()))) {
        fs::create_directories(folder_);
    }
    ~ClientFile() override { fs::remove_all(folder_); }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    fs::path folder_;
};

TEST_F(ClientFile, WritesFoldersAndWholeFiles) {
    const std::string content("a\0b\n", 4);
    write_output(folder_ / "x" / "y" / "f.png", content);
    EXPECT_EQ(read_input(folder_ / "x" / "y" / "f.png"), content);
    write_output(folder_ / "x" / "y" / "f.png", "");
    EXPECT_EQ(read_input(folder_ / "x" / "y" / "f.png"), "");
    fs::remove_all(folder_ / "x");
    EXPECT_EQ(entries(), 0U);
}

TEST_F(ClientFile, LeavesNothingBehindWhereItCannotWrite) {
    fs::create_directories(folder_ / "taken");
    try {
        write_output(folder_ / "taken", "x");
        ADD_FAILURE() << "replaced a folder";
    } catch (const ClientError& error) {
        EXPECT_EQ(error.code(), ExitCode::local_failure);
    }
    EXPECT_EQ(entries(), 1U);
    write_output(folder_ / "file", "x");
    EXPECT_THROW(write_output(folder_ / "file" / "below", "x"), ClientError);
    EXPECT_EQ(entries(), 2U);
}

TEST_F(ClientFile, NamesAnInputThatIsNotThere) {
    try {
        read_input(folder_ / "none.glb");
        ADD_FAILURE();
    } catch (const ClientError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        EXPECT_EQ(error.what(), (folder_ / "none.glb").string() + ": no such file");
    }
    EXPECT_THROW(read_input(folder_), ClientError);
}

TEST(SceneContentType, FollowsTheEnding) {
    EXPECT_EQ(scene_content_type("a.glb"), "model/gltf-binary");
    EXPECT_EQ(scene_content_type("a.b.GLTF"), "model/gltf+json");
    EXPECT_EQ(scene_content_type("a.obj"), "model/obj");
    EXPECT_EQ(scene_content_type("dir.glb/a.json"), "application/json");
    for (const char* bad : {"a", "a.png", "glb", ".glb", "a.glb.gz"})
        EXPECT_THROW(scene_content_type(bad), ClientError) << bad;
}

}  // namespace
}  // namespace afterglow::client
