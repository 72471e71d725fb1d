#include "solver/base/pixels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "solver/base/error.h"

namespace afterglow {

namespace {

constexpr int max_side = 16384;
constexpr std::int64_t max_pixels = std::int64_t{64} << 20;

void check_size(const OIIO::ImageSpec& spec, const std::string& place) {
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0)
        throw Error(ErrorKind::invalid_input, place, "the picture is empty");
    if (spec.width > max_side || spec.height > max_side ||
        std::int64_t{spec.width} * std::int64_t{spec.height} > max_pixels)
        throw Error(ErrorKind::too_large, place,
                    "a picture of " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
                        " pixels is past the limit of 16384 a side and 64 Mi in all");
}

/// Writes `spec` and `data` through the library into memory.
template <class T>
std::string encode(const char* extension, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type,
                   const T* data) {
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput target(bytes);
    auto output = OIIO::ImageOutput::create(extension, &target);
    if (!output || !output->open(extension, spec) || !output->write_image(type, data) || !output->close())
        throw Error(ErrorKind::io, "", std::string("cannot encode a picture as ") + extension);
    return {bytes.begin(), bytes.end()};
}

}  // namespace

Bytes8 decode_picture(std::string_view bytes, const std::string& place) {
    // The library wants a name to guess the format from; it tells PNG from JPEG by content once a reader is
    // open.
    const bool is_png = bytes.substr(0, 4) == "\x89PNG";
    OIIO::Filesystem::IOMemReader source(const_cast<char*>(bytes.data()), bytes.size());
    auto input = OIIO::ImageInput::open(is_png ? "picture.png" : "picture.jpg", nullptr, &source);
    if (!input) throw Error(ErrorKind::invalid_input, place, "not a readable PNG or JPEG picture");
    const OIIO::ImageSpec& spec = input->spec();
    check_size(spec, place);
    const auto count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    std::vector<std::uint8_t> raw(count * channels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, raw.data()))
        throw Error(ErrorKind::invalid_input, place, "the picture is damaged");

    Bytes8 out{spec.width, spec.height, std::vector<std::uint8_t>(count * 4, 255)};
    const bool grey = channels < 3;
    const bool has_alpha = channels == 2 || channels >= 4;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t c = 0; c < 3; ++c) out.rgba[4 * i + c] = raw[channels * i + (grey ? 0 : c)];
        if (has_alpha) out.rgba[4 * i + 3] = raw[channels * i + (grey ? 1 : 3)];
    }
    return out;
}

Picture read_picture(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) throw Error(ErrorKind::not_found, path.string(), "no such file");
    auto input = OIIO::ImageInput::open(path.string());
    if (!input) throw Error(ErrorKind::invalid_input, path.string(), "not a readable picture");
    const OIIO::ImageSpec& spec = input->spec();
    check_size(spec, path.string());
    if (spec.nchannels < 3) throw Error(ErrorKind::invalid_input, path.string(), "has fewer than 3 channels");
    Picture out(spec.width, spec.height);
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, out.pixels.data()))
        throw Error(ErrorKind::invalid_input, path.string(), "the picture is damaged");
    return out;
}

std::string encode_exr(const Picture& picture) {
    OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::FLOAT);
    // ZIP takes 15 times as long and saves a twelfth: the low bits of radiance are noise to it.
    spec.attribute("compression", "none");
    // Left out, the library writes the current time, and no two runs would make the same bytes.
    spec.attribute("DateTime", "");
    return encode("exr", spec, OIIO::TypeDesc::FLOAT, picture.pixels.data());
}

std::string encode_png(int width, int height, const std::vector<std::uint8_t>& rgb) {
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("png:compressionLevel", 4);
    return encode("png", spec, OIIO::TypeDesc::UINT8, rgb.data());
}

}  // namespace afterglow
