#include "client/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <sstream>

namespace afterglow::client {

std::string one_line(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
        if (byte == 0xC2 && next >= 0x80 && next < 0xA0) {  // U+0080 to U+009F: among them the 8-bit CSI
            out += ' ';
            ++i;
        } else {
            out += byte < 0x20 || byte == 0x7F ? ' ' : text[i];
        }
    }
    return out;
}

std::string percent_encode(std::string_view text) {
    constexpr std::string_view unreserved =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string out;
    for (const char c : text) {
        if (unreserved.find(c) != std::string_view::npos) {
            out += c;
            continue;
        }
        const auto byte = static_cast<unsigned char>(c);
        out += '%';
        out += digits[byte >> 4U];
        out += digits[byte & 15U];
    }
    return out;
}

std::string spoken(std::chrono::duration<double> duration) {
    // A century is past anything worth reading, and keeps the conversion in range.
    const double seconds = std::clamp(duration.count(), 0.0, 3.2e9);
    const auto whole = static_cast<long long>(std::ceil(seconds));
    std::array<char, 64> buffer{};
    if (whole < 60)
        std::snprintf(buffer.data(), buffer.size(), "%lld s", whole);
    else if (whole < 3600)
        std::snprintf(buffer.data(), buffer.size(), "%lld min %02lld s", whole / 60, whole % 60);
    else
        std::snprintf(buffer.data(), buffer.size(), "%lld h %02lld min", whole / 3600, whole / 60 % 60);
    return buffer.data();
}

std::string spoken_bytes(double bytes) {
    const char* unit = "bytes";
    for (const char* larger : {"kB", "MB", "GB", "TB"}) {
        if (bytes < 999.5) break;
        bytes /= 1000;
        unit = larger;
    }
    std::ostringstream text;
    text << std::fixed << std::setprecision(bytes < 9.95 && std::string_view(unit) != "bytes" ? 1 : 0)
         << bytes << ' ' << unit;
    return text.str();
}

std::string percent(double share) {
    std::array<char, 64> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.2g %%", share * 100);
    // %g turns 100 into 1e+02; whole percents read better there.
    if (std::abs(share) >= 0.995) std::snprintf(buffer.data(), buffer.size(), "%.0f %%", share * 100);
    return buffer.data();
}

}  // namespace afterglow::client
