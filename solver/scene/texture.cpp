#include "solver/scene/texture.h"

#include <array>
#include <cmath>

namespace afterglow {

namespace {

using Table = std::array<float, 256>;

Table make_table() {
    Table table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double code = static_cast<double>(i) / 255;
        table[i] = static_cast<float>(code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4));
    }
    return table;
}

const Table& table() {
    static const Table linear = make_table();
    return linear;
}

Rgb texel(const Texture& texture, const Table& linear, std::size_t x, std::size_t y) {
    const std::size_t first = 4 * (y * static_cast<std::size_t>(texture.width) + x);
    return {linear[texture.rgba[first]], linear[texture.rgba[first + 1]], linear[texture.rgba[first + 2]]};
}

/// The two texels on either side of a coordinate along one axis, and how far the second counts.
struct Between {
    std::size_t first;
    std::size_t second;
    float share;
};

Between between(float coordinate, int size) {
    // Reduced to one period first, so that far repeats keep their digits and every index fits.
    const float fraction = coordinate - std::floor(coordinate);
    if (!std::isfinite(fraction)) return {0, 0, 0};
    const float position = fraction * static_cast<float>(size) - 0.5F;
    const float low = std::floor(position);
    const int first = (static_cast<int>(low) + size) % size;
    return {static_cast<std::size_t>(first), static_cast<std::size_t>((first + 1) % size), position - low};
}

}  // namespace

float linear_from_srgb(std::uint8_t code) {
    return table()[code];
}

Rgb mean_colour(const Texture& texture) {
    const std::size_t count = texture.rgba.size() / 4;
    if (count == 0) return Rgb(1);
    const Table& linear = table();
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 3; ++c) sum[c] += double{linear[texture.rgba[4 * i + c]]};
    const auto mean = [&](std::size_t c) { return static_cast<float>(sum[c] / static_cast<double>(count)); };
    return {mean(0), mean(1), mean(2)};
}

Rgb Texture::at(const Vec2& uv) const {
    if (width <= 0 || height <= 0) return Rgb(1);
    const Table& linear = table();
    const Between x = between(uv.x, width);
    const Between y = between(uv.y, height);
    const Rgb upper = (1 - x.share) * texel(*this, linear, x.first, y.first) +
                      x.share * texel(*this, linear, x.second, y.first);
    const Rgb lower = (1 - x.share) * texel(*this, linear, x.first, y.second) +
                      x.share * texel(*this, linear, x.second, y.second);
    return (1 - y.share) * upper + y.share * lower;
}

}  // namespace afterglow
