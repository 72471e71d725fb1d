#include "solver/base/pixels.h"

#include <filesystem>
#include <random>
#include <regex>
#include <unistd.h>

#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "solver/base/file.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

class Pixels : public testing::Test {
  protected:
    void TearDown() override { fs::remove(file_); }

    fs::path file_ =
        fs::path(testing::TempDir()) / ("afterglow_pixels_" + std::to_string(::getpid()) + ".exr");
};

TEST_F(Pixels, ExrKeepsEveryBitAndTheOrderOfPixels) {
    std::mt19937 random(7);
    std::lognormal_distribution<float> value(0, 8);
    Picture picture(31, 17);
    for (Rgb& pixel : picture.pixels) pixel = Rgb(value(random), -value(random), value(random));
    write_file(file_, encode_exr(picture));
    const Picture read = read_picture(file_);
    EXPECT_EQ(read.width, 31);
    EXPECT_EQ(read.height, 17);
    EXPECT_EQ(read.pixels, picture.pixels);
}

TEST_F(Pixels, EncodingIsReproducible) {
    const Picture picture(8, 8);
    EXPECT_EQ(encode_exr(picture), encode_exr(picture));
    // A time of writing, as the library would put in, reads 2026:11:22 12:34:56.
    EXPECT_FALSE(std::regex_search(encode_exr(picture), std::regex("[0-9]{4}:[0-9]{2}:[0-9]{2} ")));
    const std::vector<std::uint8_t> rgb(192, 77);
    EXPECT_EQ(encode_png(8, 8, rgb), encode_png(8, 8, rgb));
}

TEST_F(Pixels, PngKeepsEveryByteAndIsOpaque) {
    std::vector<std::uint8_t> rgb(16 * 16 * 3);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(i);
    const Bytes8 read = decode_picture(encode_png(16, 16, rgb), "p");
    ASSERT_EQ(read.rgba.size(), 16U * 16 * 4);
    for (std::size_t i = 0; i < 256; ++i) {
        for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(read.rgba[4 * i + c], rgb[3 * i + c]);
        ASSERT_EQ(read.rgba[4 * i + 3], 255);
    }
}

TEST_F(Pixels, DamagedBytesAreErrorsThatNameThePicture) {
    const std::string png = encode_png(64, 64, std::vector<std::uint8_t>(64 * 64 * 3, 9));
    for (const std::string& bytes :
         {std::string(), std::string("no picture"), png.substr(0, 20), png.substr(0, png.size() / 2)}) {
        try {
            decode_picture(bytes, "wood.png");
            ADD_FAILURE() << bytes.size() << " bytes were a picture";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::invalid_input);
            EXPECT_EQ(e.place(), "wood.png");
        }
    }
}

TEST_F(Pixels, AHugePictureIsRefusedByItsHeader) {
    std::string png = encode_png(1, 1, std::vector<std::uint8_t>(3));
    // Width and height stand big-endian at bytes 16 and 20; the reader checks the header's checksum, so
    // either refusal will do, as long as nothing of that size is allocated.
    for (const std::size_t byte : {16U, 17U, 20U, 21U}) png[byte] = '\x7f';
    EXPECT_THROW(decode_picture(png, "bomb.png"), Error);
}

TEST_F(Pixels, ReadingWhatIsNoPictureFails) {
    EXPECT_THROW(read_picture(file_), Error);
    write_file(file_, "not an exr");
    EXPECT_THROW(read_picture(file_), Error);
}

}  // namespace
}  // namespace afterglow
