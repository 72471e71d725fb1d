#include "solver/image/frame_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "solver/base/file.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;
using testing::UnorderedElementsAre;

class FrameFiles : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("afterglow_frames_" + std::to_string(::getpid()));
        fs::remove_all(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> out;
        for (const auto& entry : fs::directory_iterator(folder_)) out.push_back(entry.path().filename());
        return out;
    }

    fs::path folder_;
};

TEST(FrameStem, HasFourDigitsOrMore) {
    EXPECT_EQ(frame_stem(0), "frame_0000");
    EXPECT_EQ(frame_stem(97), "frame_0097");
    EXPECT_EQ(frame_stem(9999), "frame_9999");
    EXPECT_EQ(frame_stem(12345), "frame_12345");
}

TEST_F(FrameFiles, WritesBothPicturesAndNothingElse) {
    Picture radiance(3, 2);
    for (std::size_t i = 0; i < radiance.pixels.size(); ++i)
        radiance.pixels[i] = Rgb(static_cast<float>(i), 1e-5F * static_cast<float>(i), 1e5F);
    std::vector<std::uint8_t> srgb(18);
    for (std::size_t i = 0; i < srgb.size(); ++i) srgb[i] = static_cast<std::uint8_t>(14 * i);

    write_frame(folder_ / "deeper", 7, radiance, srgb);
    folder_ /= "deeper";

    EXPECT_THAT(names(), UnorderedElementsAre("frame_0007.exr", "frame_0007.png"));
    const Picture read = read_picture(folder_ / "frame_0007.exr");
    EXPECT_EQ(read.pixels, radiance.pixels);
    const Bytes8 png = decode_picture(read_file(folder_ / "frame_0007.png"), "png");
    ASSERT_EQ(png.width, 3);
    ASSERT_EQ(png.height, 2);
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(png.rgba[4 * i + c], srgb[3 * i + c]);
}

TEST_F(FrameFiles, ReplacesAnOlderFrame) {
    const std::vector<std::uint8_t> srgb(3, 128);
    Picture radiance(1, 1);
    write_frame(folder_, 0, radiance, srgb);
    radiance.pixels[0] = Rgb(2);
    write_frame(folder_, 0, radiance, srgb);
    EXPECT_EQ(read_picture(folder_ / "frame_0000.exr").pixels[0], Rgb(2));
    EXPECT_EQ(names().size(), 2U);
}

TEST_F(FrameFiles, AFolderThatCannotBeIsAnErrorThatNamesIt) {
    std::ofstream(folder_) << "in the way";
    try {
        write_frame(folder_ / "sub", 0, Picture(1, 1), std::vector<std::uint8_t>(3));
        FAIL() << "wrote into a file";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::io);
        EXPECT_EQ(e.place(), (folder_ / "sub").string());
    }
    EXPECT_EQ(read_file(folder_), "in the way");
}

}  // namespace
}  // namespace afterglow
