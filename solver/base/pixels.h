#pragma once

// The only place that uses OpenEXR, libspng and TurboJPEG: pictures between memory, encoded bytes and files.
// Pictures of other formats: other_pictures.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "solver/base/math.h"

namespace afterglow {

/// A picture of linear float RGB, row by row from the top left.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Rgb> pixels;  ///< width × height

    Picture() = default;
    Picture(int w, int h)
        : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), Rgb(0)) {}
    Rgb& at(int x, int y) {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    [[nodiscard]] const Rgb& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

/// 8-bit RGBA as stored in a file (sRGB-coded colour, linear alpha), row by row from the top left.
struct Bytes8 {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  ///< width × height × 4
};

/// Whether a picture is past what is read of any format: 16,384 pixels a side, 64 Mi in all.
constexpr bool is_too_large(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t max_side = 16384;
    constexpr std::int64_t max_pixels = std::int64_t{64} << 20U;
    return width > max_side || height > max_side || width * height > max_pixels;
}

/// Decodes PNG or JPEG; their colour profiles and gamma are ignored. `place` names the picture in errors.
/// Errors: invalid_input for bytes that are no picture; too_large past 16,384 pixels a side or 64 Mi pixels
/// in all.
Bytes8 decode_picture(std::string_view bytes, const std::string& place);

/// Reads the channels R, G and B of an OpenEXR file as floats. Errors: not_found, invalid_input, too_large.
Picture read_picture(const std::filesystem::path& path);

/// Encodes as OpenEXR, 32-bit float RGB, uncompressed.
std::string encode_exr(const Picture& picture);
/// Encodes 8-bit RGB as PNG. `rgb` has width × height × 3 bytes, already sRGB-coded.
std::string encode_png(int width, int height, const std::vector<std::uint8_t>& rgb);

}  // namespace afterglow
