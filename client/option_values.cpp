#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "client/options.h"

namespace afterglow::client {

namespace {

/// A whole text as a finite number, or nothing.
template <typename Number>
std::optional<Number> number_in(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    if (!std::isfinite(static_cast<double>(value))) return std::nullopt;
    return value;
}

}  // namespace

std::pair<int, int> parse_size(const std::string& text) {
    const auto cross = text.find('x');
    if (cross != std::string::npos) {
        const auto width = number_in<int>(std::string_view(text).substr(0, cross));
        const auto height = number_in<int>(std::string_view(text).substr(cross + 1));
        const auto fits = [](int pixels) { return pixels >= 1 && pixels <= 16384; };
        if (width && height && fits(*width) && fits(*height)) return {*width, *height};
    }
    throw ClientError(ExitCode::bad_input, "--size",
                      "\"" + text + "\" is not WIDTHxHEIGHT, each from 1 to 16384, such as 640x360");
}

double parse_share(const std::string& text) {
    std::string_view digits = text;
    const double scale = digits.ends_with('%') ? 0.01 : 1;
    if (digits.ends_with('%')) digits.remove_suffix(1);
    const auto value = number_in<double>(digits);
    if (value && *value * scale > 0 && *value * scale < 1) return *value * scale;
    throw ClientError(ExitCode::bad_input, "--error",
                      "\"" + text + "\" is not an error between 0 and 1, such as 0.02 or 2%");
}

std::vector<double> parse_rgb(const std::string& text) {
    std::vector<double> channels;
    std::string_view rest = text;
    for (;;) {
        const auto comma = rest.find(',');
        const auto value = number_in<double>(rest.substr(0, comma));
        if (!value || *value < 0) break;
        channels.push_back(*value);
        if (comma == std::string_view::npos) {
            if (channels.size() == 3) return channels;
            break;
        }
        rest.remove_prefix(comma + 1);
    }
    throw ClientError(ExitCode::bad_input, "--background",
                      "\"" + text + "\" is not three numbers of 0 or more, such as 0.2,0.3,0.5");
}

double parse_unit(const std::string& text) {
    constexpr std::array<std::pair<std::string_view, double>, 5> units{
        {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}}};
    for (const auto& [name, metres] : units)
        if (text == name) return metres;
    const auto value = number_in<double>(text);
    if (value && *value > 0) return *value;
    throw ClientError(ExitCode::bad_input, "--unit",
                      "\"" + text + "\" is none of m, cm, mm, in, ft, nor metres as a number above 0");
}

Json settings_json(const JobSettings& settings) {
    Json json = Json::object();
    const auto put = [&json](const char* key, const auto& value) {
        if (value) json[key] = *value;
    };
    put("frames", settings.frames);
    put("fps", settings.fps);
    put("width", settings.width);
    put("height", settings.height);
    put("quality", settings.quality);
    put("estimate", settings.estimate);
    put("method", settings.method);
    put("visibility", settings.visibility);
    put("solution", settings.solution);
    put("rays", settings.rays);
    put("patch_size_m", settings.patch_size_m);
    put("error", settings.error);
    put("camera", settings.camera);
    put("seed", settings.seed);
    put("exposure_ev", settings.exposure_ev);
    put("background", settings.background);
    return json;
}

}  // namespace afterglow::client
