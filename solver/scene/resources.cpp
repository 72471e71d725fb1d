#include "solver/scene/resources.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <system_error>
#include <utility>

#include "solver/base/error.h"
#include "solver/base/file.h"

namespace afterglow {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const std::string& uri, const std::string& why) {
    throw Error(ErrorKind::invalid_input, in_quotes(uri), why);
}

std::optional<unsigned> hex_digit(char c) {
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
    if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
    if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A' + 10);
    return std::nullopt;
}

std::string percent_decoded(const std::string& uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            out += uri[i];
            continue;
        }
        const auto high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : std::nullopt;
        const auto low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : std::nullopt;
        if (!high || !low) refuse(uri, "a % that is not followed by two hexadecimal digits");
        out += static_cast<char>(*high * 16 + *low);
        i += 2;
    }
    return out;
}

/// RFC 3986, section 3.1: a letter, then letters, digits, + - . up to a colon.
bool has_scheme(const std::string& uri) {
    const auto is_scheme_character = [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.';
    };
    const auto end = std::find_if_not(uri.begin(), uri.end(), is_scheme_character);
    return end != uri.begin() && end != uri.end() && *end == ':' &&
           std::isalpha(static_cast<unsigned char>(uri.front())) != 0;
}

bool is_inside(const fs::path& path, const fs::path& folder) {
    const auto [rest, end] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return rest == folder.end() && end != path.end();
}

std::string read_inside(const fs::path& folder, const std::string& uri, std::size_t max_bytes) {
    const fs::path wanted = folder / relative_path(uri);
    std::error_code error;
    const fs::path root = fs::canonical(folder, error);
    if (error) throw Error(ErrorKind::io, folder.string(), error.message());
    const fs::path real = fs::weakly_canonical(wanted, error);
    if (error) throw Error(ErrorKind::io, in_quotes(uri), error.message());
    if (!is_inside(real, root)) refuse(uri, "leads outside the scene's folder");
    try {
        return read_file(real, max_bytes);
    } catch (const Error& e) {
        throw Error(e.kind(), in_quotes(uri), e.message());
    }
}

}  // namespace

fs::path relative_path(const std::string& uri) {
    if (has_scheme(uri)) refuse(uri, "only paths relative to the scene's folder are read");
    std::string text = percent_decoded(uri);
    if (text.empty()) refuse(uri, "names no file");
    if (text.find('\0') != std::string::npos) refuse(uri, "contains a zero byte");
    std::replace(text.begin(), text.end(), '\\', '/');
    fs::path path = fs::path(text).lexically_normal();
    if (path.has_root_path() || has_scheme(text))
        refuse(uri, "only paths relative to the scene's folder are read");
    if (*path.begin() == "..") refuse(uri, "leads outside the scene's folder");
    return path;
}

ResourceReader resources_in(fs::path folder, std::size_t max_bytes) {
    if (folder.empty()) folder = ".";
    return [folder = std::move(folder), max_bytes](const std::string& uri) {
        return read_inside(folder, uri, max_bytes);
    };
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t most = 80;
    const bool shortened = text.size() > most;
    std::size_t length = shortened ? most - 3 : text.size();
    // Cut between characters: continuation bytes of UTF-8 read 10xxxxxx.
    while (shortened && length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) --length;
    std::string out = "\"";
    for (const char c : text.substr(0, length)) {
        const auto byte = static_cast<unsigned char>(c);
        out += byte < 0x20U || byte == 0x7FU ? '?' : c;
    }
    return out + (shortened ? "...\"" : "\"");
}

}  // namespace afterglow
