#include "solver/base/pixels.h"

#include <filesystem>
#include <random>
#include <regex>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

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

/// The bytes that pairs of hexadecimal digits stand for.
std::string bytes_of(std::string_view digits) {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        bytes.push_back(static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16)));
    return bytes;
}

using Texels = std::vector<std::uint8_t>;

TEST_F(Pixels, EveryKindOfPngBecomesEightBitsAChannel) {
    const std::string header = "89504e470d0a1a0a0000000d49484452";
    const std::string end = "0000000049454e44ae426082";
    // Two pixels, grey with alpha.
    EXPECT_EQ(decode_picture(bytes_of(header +
                                      "000000020000000108040000005e2bb7010000000d4944415478da63e0fa7fa2010005"
                                      "3a02522eeed822" +
                                      end),
                             "p")
                  .rgba,
              (Texels{10, 10, 10, 255, 200, 200, 200, 128}));
    // A palette whose first colour is transparent.
    EXPECT_EQ(
        decode_picture(bytes_of(header +
                                "00000002000000010803000000c3fc8fb800000006504c5445010203fa6432775b9fc1"
                                "0000000274524e5300ff5b9122b50000000b4944415478da63606400000005000242c2449f" +
                                end),
                       "p")
            .rgba,
        (Texels{250, 100, 50, 255, 1, 2, 3, 0}));
    // Sixteen bits a channel; that it says its gamma is 1 counts for nothing.
    EXPECT_EQ(decode_picture(bytes_of(header +
                                      "00000001000000011002000000c0e78f9d0000000467414d41000186a031e8965f0000"
                                      "000f4944415478da6370606860f8ff1f00068402bf3e076c85" +
                                      end),
                             "p")
                  .rgba,
              (Texels{0x40, 0x80, 0xff, 255}));
    // One bit a pixel.
    EXPECT_EQ(decode_picture(bytes_of(header +
                                      "000000020000000101000000"
                                      "00dc5942270000000a4944415478da637000000042004184bf8e62" +
                                      end),
                             "p")
                  .rgba,
              (Texels{0, 0, 0, 255, 255, 255, 255, 255}));
}

TEST_F(Pixels, JpegIsReadAndADamagedOneIsAnError) {
    // 8×8 pixels of one colour.
    const std::string jpeg = bytes_of(
        "ffd8ffe000104a46494600010100000100010000ffe1001645786966000049492a0008000000000000000000ffdb00430002"
        "01010101010201010102020202020403020202020504040304060506060605060606070908060709070606080b08090a0a0a"
        "0a0a06080b0c0b0a0c090a0a0affdb004301020202020202050303050a0706070a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a"
        "0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0affc000110800080008030111000211010311"
        "01ffc4001f0000010501010101010100000000000000000102030405060708090a0bffc400b5100002010303020403050504"
        "040000017d01020300041105122131410613516107227114328191a1082342b1c11552d1f02433627282090a161718191a25"
        "262728292a3435363738393a434445464748494a535455565758595a636465666768696a737475767778797a838485868788"
        "898a92939495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae1e2e3"
        "e4e5e6e7e8e9eaf1f2f3f4f5f6f7f8f9faffc4001f0100030101010101010101010000000000000102030405060708090a0b"
        "ffc400b51100020102040403040705040400010277000102031104052131061241510761711322328108144291a1b1c10923"
        "3352f0156272d10a162434e125f11718191a262728292a35363738393a434445464748494a535455565758595a6364656667"
        "68696a737475767778797a82838485868788898a92939495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6b7b8b9bac2c3c4"
        "c5c6c7c8c9cad2d3d4d5d6d7d8d9dae2e3e4e5e6e7e8e9eaf2f3f4f5f6f7f8f9faffda000c03010002110311003f00cfafe5"
        "73fb60ffd9");
    const Bytes8 read = decode_picture(jpeg, "p");
    ASSERT_EQ(read.rgba.size(), 4U * 64);
    for (std::size_t i = 0; i < 64; ++i) {
        ASSERT_NEAR(read.rgba[4 * i], 200, 2);
        ASSERT_NEAR(read.rgba[4 * i + 1], 100, 2);
        ASSERT_NEAR(read.rgba[4 * i + 2], 50, 2);
        ASSERT_EQ(read.rgba[4 * i + 3], 255);
    }
    EXPECT_THROW(decode_picture(jpeg.substr(0, 100), "wood.jpg"), Error);
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
