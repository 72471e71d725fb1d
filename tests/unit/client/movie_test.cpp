#include "client/movie.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <sys/stat.h>

#include <gmock/gmock.h>

#include "client/error.h"

namespace afterglow::client {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder that stands alone in PATH while a test runs, with an ffmpeg of the test's own or none.
class Movie : public testing::Test {
  protected:
    void SetUp() override {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        path_ = std::getenv("PATH");
        setenv("PATH", folder_.c_str(), 1);
    }
    void TearDown() override { setenv("PATH", path_.c_str(), 1); }

    /// An ffmpeg that notes its arguments, writes its last one and ends so.
    void install(int status) {
        const auto file = folder_ / "ffmpeg";
        std::ofstream(file) << "#!/bin/sh\necho \"$@\" >" << (folder_ / "said").string()
                            << "\n[ \"$1\" = -version ] && exit 0\nfor last; do :; done\n: >\"$last\"\nexit "
                            << status << '\n';
        chmod(file.c_str(), 0755);
    }
    std::string said() {
        std::stringstream text;
        text << std::ifstream(folder_ / "said").rdbuf();
        return text.str();
    }

    fs::path folder_ = fs::path(testing::TempDir()) / "movie";
    std::string path_;
};

TEST_F(Movie, IsMadeOfTheFramesFromTheFirstOn) {
    install(0);
    EXPECT_EQ(find_movie_maker(), MovieMaker::present);
    make_movie({"100% frames", 12, 12.5}, folder_ / "out.mp4");
    EXPECT_THAT(said(), HasSubstr("-framerate 12.5"));
    EXPECT_THAT(said(), HasSubstr("-start_number 12 -i 100%% frames/frame_%04d.png"));
    EXPECT_TRUE(fs::exists(folder_ / "out.mp4"));
    EXPECT_FALSE(fs::exists(folder_ / "out.part.mp4"));
}

TEST_F(Movie, NeedsFfmpeg) {
    EXPECT_EQ(find_movie_maker(), MovieMaker::missing);
    try {
        make_movie({}, "out.mp4");
        ADD_FAILURE() << "made";
    } catch (const ClientError& error) {
        EXPECT_EQ(error.code(), ExitCode::local_failure);
        EXPECT_THAT(error.what(), HasSubstr("ffmpeg"));
    }
}

TEST_F(Movie, AFailureLeavesAnOlderOneAsItWas) {
    install(1);
    std::ofstream(folder_ / "out.mp4") << "older";
    EXPECT_THROW(make_movie({}, folder_ / "out.mp4"), ClientError);
    EXPECT_EQ(fs::file_size(folder_ / "out.mp4"), 5U);
    EXPECT_FALSE(fs::exists(folder_ / "out.part.mp4"));
}

}  // namespace
}  // namespace afterglow::client
