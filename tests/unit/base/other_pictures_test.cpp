#include "solver/base/other_pictures.h"

#include <string>

#include <gtest/gtest.h>

#include "solver/base/error.h"

namespace afterglow {
namespace {

using Texels = std::vector<std::uint8_t>;

std::string bytes_of(std::initializer_list<int> values) {
    std::string bytes;
    for (const int value : values) bytes.push_back(static_cast<char>(value));
    return bytes;
}

/// A TGA of 2 by 1 pixels, uncompressed, blue first: red, then green at half opacity.
const std::string tga = bytes_of({0, 0, 2,   0,   0, 0,   0, 0,  0, 0, 0, 0, 2, 0, 1, 0, 32, 0x28,  //
                                  0, 0, 255, 255, 0, 255, 0, 255});

/// A BMP of 1 by 1 pixel, blue first.
const std::string bmp = bytes_of(
    {'B', 'M', 58, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0,  0,  1,  0, 24, 0,  //
     0,   0,   0,  0, 4, 0, 0, 0, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0, 0, 0, 0, 0, 0, 30, 20, 10, 0});

TEST(OtherPictures, TgaAndBmpBecomeEightBitsAChannel) {
    const Bytes8 first = decode_texture(tga, "a.tga");
    EXPECT_EQ(first.width, 2);
    EXPECT_EQ(first.height, 1);
    EXPECT_EQ(first.rgba, (Texels{255, 0, 0, 255, 0, 255, 0, 255}));
    EXPECT_EQ(decode_texture(bmp, "a.bmp").rgba, (Texels{10, 20, 30, 255}));
}

TEST(OtherPictures, PngNeedsNoModule) {
    const std::string png = encode_png(1, 1, {7, 8, 9});
    EXPECT_EQ(decode_texture(png, "a.png").rgba, (Texels{7, 8, 9, 255}));
}

TEST(OtherPictures, DamagedBytesAreErrorsThatNameThePicture) {
    for (const std::string& bytes :
         {std::string(), std::string("no picture"), bmp.substr(0, 20), tga.substr(0, 19)}) {
        try {
            decode_texture(bytes, "wood");
            ADD_FAILURE() << bytes.size() << " bytes were a picture";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::invalid_input);
            EXPECT_EQ(e.place(), "wood");
        }
    }
}

TEST(OtherPictures, AHugePictureIsRefusedByItsHeader) {
    std::string huge = tga;
    for (const std::size_t byte : {12U, 13U, 14U, 15U}) huge[byte] = '\x7f';
    try {
        decode_texture(huge, "bomb.tga");
        ADD_FAILURE() << "was read";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::too_large);
    }
}

}  // namespace
}  // namespace afterglow
