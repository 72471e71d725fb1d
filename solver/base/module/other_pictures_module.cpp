// The only place that uses OpenImageIO; a shared library of its own, see other_pictures.h.

#include <array>
#include <cstddef>
#include <new>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "solver/base/other_pictures.h"

namespace afterglow {

namespace {

/// A name with the ending that the library tells the format by; the first bytes say which. TGA has no mark,
/// so it is what is left.
const char* name_for(std::string_view bytes) {
    using Mark = std::pair<std::string_view, const char*>;
    constexpr std::array<Mark, 5> marks{{{{"II*\0", 4}, "picture.tif"},
                                         {{"MM\0*", 4}, "picture.tif"},
                                         {"BM", "picture.bmp"},
                                         {"GIF8", "picture.gif"},
                                         {"RIFF", "picture.webp"}}};
    for (const auto& [mark, name] : marks)
        if (bytes.starts_with(mark)) return name;
    return "picture.tga";
}

DecodeFailure decode(std::string_view bytes, Bytes8& out) {
    OIIO::Filesystem::IOMemReader source(const_cast<char*>(bytes.data()), bytes.size());
    auto input = OIIO::ImageInput::open(name_for(bytes), nullptr, &source);
    if (!input) {
        OIIO::geterror();  // the library keeps the text until somebody takes it
        return DecodeFailure::unreadable;
    }
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) return DecodeFailure::unreadable;
    if (is_too_large(spec.width, spec.height)) return DecodeFailure::too_large;

    const auto count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    std::vector<std::uint8_t> raw(count * channels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, raw.data()))
        return DecodeFailure::damaged;

    out = {spec.width, spec.height, std::vector<std::uint8_t>(count * 4, 255)};
    const bool is_grey = channels < 3;
    const bool has_alpha = channels == 2 || channels >= 4;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t c = 0; c < 3; ++c) out.rgba[4 * i + c] = raw[channels * i + (is_grey ? 0 : c)];
        if (has_alpha) out.rgba[4 * i + 3] = raw[channels * i + (is_grey ? 1 : 3)];
    }
    return DecodeFailure::none;
}

}  // namespace

}  // namespace afterglow

extern "C" afterglow::DecodeFailure afterglow_decode_other_picture(std::string_view bytes,
                                                                   afterglow::Bytes8& out) {
    try {
        return afterglow::decode(bytes, out);
    } catch (const std::exception&) {
        return afterglow::DecodeFailure::damaged;
    }
}
