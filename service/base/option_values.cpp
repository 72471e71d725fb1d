#include "service/base/option_values.h"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "solver/base/error.h"

namespace afterglow {

namespace {

constexpr std::int64_t max_side = 16384;
constexpr std::int64_t max_pixels = std::int64_t{64} << 20;

[[noreturn]] void fail(const std::string& place, const std::string& expected, std::string_view found) {
    throw Error(ErrorKind::invalid_input, place,
                "expected " + expected + ", found \"" + std::string(found) + "\"");
}

/// The whole text as a number; false where it is anything else.
template <class Number>
bool read_number(std::string_view text, Number& value) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end;
}

std::string shown(double number) {
    std::array<char, 32> text{};
    const auto result = std::to_chars(text.data(), text.data() + text.size(), number);
    return {text.data(), result.ptr};
}

/// The texts between separators.
std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const auto at = text.find(separator);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos) return parts;
        text.remove_prefix(at + 1);
    }
}

/// A whole number above 0 followed by one of the units.
template <std::size_t n>
std::int64_t with_unit(const std::string& place, std::string_view text, const std::string& expected,
                       const std::array<std::pair<std::string_view, std::int64_t>, n>& units) {
    constexpr std::int64_t most = std::int64_t{1} << 53U;
    for (const auto& [name, size] : units) {
        std::int64_t value = 0;
        if (!text.ends_with(name) || !read_number(text.substr(0, text.size() - name.size()), value)) continue;
        if (value > 0 && value <= most / size) return value * size;
    }
    fail(place, expected, text);
}

}  // namespace

std::chrono::seconds length_of_time(const std::string& place, std::string_view text) {
    constexpr std::array<std::pair<std::string_view, std::int64_t>, 4> units{
        {{"s", 1}, {"m", 60}, {"h", 3600}, {"d", 86'400}}};
    return std::chrono::seconds(with_unit(place, text, "a length of time such as 90m, 12h or 7d", units));
}

std::uint64_t byte_count(const std::string& place, std::string_view text) {
    constexpr std::array<std::pair<std::string_view, std::int64_t>, 4> units{
        {{"kB", 1000}, {"MB", 1'000'000}, {"GB", 1'000'000'000}, {"TB", 1'000'000'000'000}}};
    return static_cast<std::uint64_t>(
        with_unit(place, text, "a number of bytes such as 500MB or 20GB", units));
}

std::int64_t whole_number(const std::string& place, std::string_view text, std::int64_t low,
                          std::int64_t high) {
    std::int64_t value = 0;
    if (!read_number(text, value) || value < low || value > high)
        fail(place, "a whole number from " + std::to_string(low) + " to " + std::to_string(high), text);
    return value;
}

double decimal_number(const std::string& place, std::string_view text, double low, double high) {
    double value = 0;
    if (!read_number(text, value) || !(value >= low && value <= high))
        fail(place, "a number from " + shown(low) + " to " + shown(high), text);
    return value;
}

double positive_number(const std::string& place, std::string_view text) {
    double value = 0;
    if (!read_number(text, value) || !std::isfinite(value) || value <= 0)
        fail(place, "a number above 0", text);
    return value;
}

double share(const std::string& place, std::string_view text) {
    const bool percent = text.ends_with('%');
    double value = 0;
    const bool is_number = read_number(text.substr(0, text.size() - (percent ? 1 : 0)), value);
    if (percent) value /= 100;
    if (!is_number || !(value > 0 && value < 1))
        fail(place, "a share between 0 and 1, such as 0.02 or 2%", text);
    return value;
}

PictureSize picture_size(const std::string& place, std::string_view text) {
    const auto sides = split(text, 'x');
    std::array<std::int64_t, 2> pixels{};
    bool valid = sides.size() == pixels.size();
    for (std::size_t i = 0; valid && i < pixels.size(); ++i)
        valid = read_number(sides[i], pixels[i]) && pixels[i] >= 1 && pixels[i] <= max_side;
    if (!valid) fail(place, "a size such as 640x360, 1 to 16384 pixels a side", text);
    if (pixels[0] * pixels[1] > max_pixels)
        throw Error(ErrorKind::invalid_input, place,
                    std::string(text) + " is past the limit of 64 Mi pixels in all");
    return {static_cast<int>(pixels[0]), static_cast<int>(pixels[1])};
}

Rgb linear_colour(const std::string& place, std::string_view text) {
    const auto channels = split(text, ',');
    std::array<float, 3> value{};
    bool valid = channels.size() == value.size();
    for (std::size_t i = 0; valid && i < value.size(); ++i)
        valid = read_number(channels[i], value[i]) && std::isfinite(value[i]) && value[i] >= 0;
    if (!valid) fail(place, "three numbers of 0 or more such as 0.1,0.2,0.4", text);
    return {value[0], value[1], value[2]};
}

double unit_in_metres(const std::string& place, std::string_view text) {
    constexpr std::array<std::pair<std::string_view, double>, 5> units{
        {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}}};
    for (const auto& [name, metres] : units)
        if (text == name) return metres;
    double value = 0;
    if (!read_number(text, value) || !std::isfinite(value) || value <= 0)
        fail(place, "m, cm, mm, in, ft or a number of metres above 0", text);
    return value;
}

}  // namespace afterglow
