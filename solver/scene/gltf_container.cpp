#include "solver/scene/gltf_container.h"

#include <cstdint>

#include "solver/base/error.h"

namespace afterglow::gltf {

namespace {

constexpr std::size_t header_bytes = 12;
constexpr std::size_t chunk_header_bytes = 8;
constexpr std::uint32_t json_chunk = 0x4E4F534AU;    // "JSON"
constexpr std::uint32_t binary_chunk = 0x004E4942U;  // "BIN\0"

std::uint32_t little_endian(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = (value << 8U) | static_cast<unsigned char>(bytes[offset + i]);
    return value;
}

/// The six bits of a base64 character, or 64 for any other.
unsigned sextet(char c) {
    if (c >= 'A' && c <= 'Z') return static_cast<unsigned>(c - 'A');
    if (c >= 'a' && c <= 'z') return static_cast<unsigned>(c - 'a' + 26);
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0' + 52);
    if (c == '+') return 62;
    if (c == '/') return 63;
    return 64;
}

std::string decode_base64(std::string_view text, const std::string& place) {
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
    if (text.size() % 4 == 1) throw Error(ErrorKind::invalid_input, place, "the base64 text is truncated");
    std::string out;
    out.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const unsigned six = sextet(c);
        if (six == 64) throw Error(ErrorKind::invalid_input, place, "a character that is no base64");
        bits = (bits << 6U) | six;
        held += 6;
        if (held < 8) continue;
        held -= 8;
        out += static_cast<char>((bits >> static_cast<unsigned>(held)) & 0xFFU);
    }
    return out;
}

std::string_view checked_header(std::string_view bytes, const std::string& name) {
    if (bytes.size() < 4 || bytes.substr(0, 4) != "glTF")
        throw Error(ErrorKind::invalid_input, name,
                    "not a binary glTF file: it does not start with \"glTF\"");
    if (bytes.size() < header_bytes)
        throw Error(ErrorKind::invalid_input, name, "the file ends inside its header");
    const std::uint32_t version = little_endian(bytes, 4);
    if (version != 2)
        throw Error(ErrorKind::unsupported, name,
                    "binary glTF version " + std::to_string(version) + "; only version 2 is read");
    const std::uint32_t length = little_endian(bytes, 8);
    if (length > bytes.size())
        throw Error(ErrorKind::invalid_input, name,
                    "truncated: the header promises " + std::to_string(length) + " bytes, there are " +
                        std::to_string(bytes.size()));
    return bytes.substr(0, length);
}

}  // namespace

Container split_glb(std::string_view bytes, const std::string& name) {
    bytes = checked_header(bytes, name);
    std::optional<std::string_view> json;
    Container out;
    std::size_t offset = header_bytes;
    // Up to three stray bytes of padding at the end are no chunk.
    while (bytes.size() >= offset + chunk_header_bytes) {
        const std::size_t length = little_endian(bytes, offset);
        const std::uint32_t type = little_endian(bytes, offset + 4);
        offset += chunk_header_bytes;
        if (length > bytes.size() - offset)
            throw Error(ErrorKind::invalid_input, name,
                        "the chunk at byte " + std::to_string(offset - chunk_header_bytes) + " of " +
                            std::to_string(length) + " bytes ends past the file");
        const std::string_view content = bytes.substr(offset, length);
        if (!json && type != json_chunk)
            throw Error(ErrorKind::invalid_input, name, "the first chunk is not JSON");
        if (!json)
            json = content;
        else if (type == binary_chunk && !out.binary)
            out.binary = content;
        offset += length;
    }
    if (!json) throw Error(ErrorKind::invalid_input, name, "there is no JSON chunk");
    out.json = *json;
    return out;
}

bool is_data_uri(std::string_view uri) {
    return uri.substr(0, 5) == "data:";
}

std::string decode_data_uri(std::string_view uri, const std::string& place) {
    constexpr std::string_view marker = ";base64,";
    const std::size_t comma = uri.find(',');
    const bool is_base64 = comma != std::string_view::npos && uri.substr(0, comma + 1).ends_with(marker);
    if (!is_base64) throw Error(ErrorKind::unsupported, place, "a data URI that is not base64");
    return decode_base64(uri.substr(comma + 1), place);
}

}  // namespace afterglow::gltf
