#include "tests/support/picture_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace afterglow::test {

namespace {

void check(const Picture& picture, const Picture& like) {
    if (picture.width != like.width || picture.height != like.height || picture.pixels.empty())
        throw std::invalid_argument("the pictures differ in size");
    for (const Rgb& pixel : picture.pixels)
        if (!is_finite(pixel)) throw std::invalid_argument("a picture has non-finite pixels");
}

/// The pixels that do not touch a lamp.
std::vector<char> usable_pixels(const Picture& a, const Picture& b, double lamp_radiance) {
    std::vector<char> usable(a.pixels.size(), 1);
    const auto bright = [&](int x, int y) {
        return std::max(max_channel(a.at(x, y)), max_channel(b.at(x, y))) > lamp_radiance;
    };
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            if (!bright(x, y)) continue;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, a.height - 1); ++v)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, a.width - 1); ++u)
                    usable[static_cast<std::size_t>(v) * static_cast<std::size_t>(a.width) +
                           static_cast<std::size_t>(u)] = 0;
        }
    return usable;
}

}  // namespace

PictureError picture_error(const Picture& picture, const Picture& half_a, const Picture& half_b,
                           double lamp_radiance) {
    for (const Picture* other : {&picture, &half_a, &half_b}) check(*other, half_a);
    const auto usable = usable_pixels(half_a, half_b, lamp_radiance);
    double difference = 0;
    double scale = 0;
    std::size_t used = 0;
    for (std::size_t i = 0; i < usable.size(); ++i) {
        if (usable[i] == 0) continue;
        ++used;
        for (int c = 0; c < 3; ++c) {
            const double value = picture.pixels[i][c];
            const double a = half_a.pixels[i][c];
            const double b = half_b.pixels[i][c];
            difference += (value - a) * (value - b);
            scale += a * b;
        }
    }
    if (used == 0 || scale <= 0) throw std::invalid_argument("no pixel of the reference can be used");
    return {std::sqrt(std::max(difference, 0.0) / scale),
            static_cast<double>(used) / static_cast<double>(usable.size())};
}

}  // namespace afterglow::test
