#include "solver/image/tone_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace afterglow {

namespace {

constexpr double middle_grey = 0.18;
constexpr double trimmed_share = 0.1;  // at each end
constexpr double largest_ev = 64;
constexpr std::size_t pixels_per_chunk = 4096;

void require_finite(const Picture& picture, std::size_t pixel) {
    const Rgb& c = picture.pixels[pixel];
    if (is_finite(c)) return;
    const auto width = static_cast<std::size_t>(picture.width);
    throw std::logic_error("pixel (" + std::to_string(pixel % width) + ", " + std::to_string(pixel / width) +
                           ") of the picture is not finite: " + std::to_string(c.r) + ", " +
                           std::to_string(c.g) + ", " + std::to_string(c.b));
}

double luminance(const Rgb& c) {
    return 0.2126 * double{c.r} + 0.7152 * double{c.g} + 0.0722 * double{c.b};
}

/// The nearest 8-bit code of a linear value, found by comparing instead of by a power.
class NearestCode {
  public:
    NearestCode() {
        const auto code_of = [](double linear) { return std::lround(255 * srgb_encoded(linear)); };
        for (std::size_t code = 1; code < begins_.size(); ++code) {
            double below = begins_[code - 1], at = 1;
            while (std::nextafter(below, at) < at) {
                const double middle = below + (at - below) / 2;
                (code_of(middle) < static_cast<long>(code) ? below : at) = middle;
            }
            begins_[code] = at;
        }
        for (std::size_t step = 0; step < first_.size(); ++step)
            first_[step] = static_cast<std::uint8_t>(code_of(static_cast<double>(step) / steps));
    }

    [[nodiscard]] std::uint8_t operator()(double linear) const {
        const double v = std::clamp(linear, 0.0, 1.0);
        std::uint8_t code = first_[static_cast<std::size_t>(v * steps)];
        while (code < 255 && v >= begins_[code + 1U]) ++code;
        return code;
    }

  private:
    /// As many that few hold more than one code's beginning.
    static constexpr int steps = 4096;
    std::array<double, 256> begins_{};             ///< least value of each code
    std::array<std::uint8_t, steps + 1> first_{};  ///< code of each step's least value
};

}  // namespace

double srgb_encoded(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

float automatic_exposure_ev(const Picture& picture) {
    std::vector<double> stops;
    stops.reserve(picture.pixels.size());
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        require_finite(picture, i);
        const double y = luminance(picture.pixels[i]);
        if (y > 0) stops.push_back(std::log2(y));
    }
    if (stops.empty()) return 0;

    // Sorted before summing, so that the sum does not depend on where in the picture a tone stands.
    std::sort(stops.begin(), stops.end());
    const auto trimmed =
        static_cast<std::ptrdiff_t>(std::floor(trimmed_share * static_cast<double>(stops.size())));
    const auto first = stops.begin() + trimmed;
    const auto last = stops.end() - trimmed;
    const double mean = std::accumulate(first, last, 0.0) / static_cast<double>(last - first);
    return static_cast<float>(std::clamp(std::log2(middle_grey) - mean, -largest_ev, largest_ev));
}

std::vector<std::uint8_t> to_srgb(const Picture& picture, float exposure_ev, const Context& context) {
    static const NearestCode code;
    const double gain = std::exp2(double{exposure_ev});
    std::vector<std::uint8_t> rgb(picture.pixels.size() * 3);
    context.for_chunks(picture.pixels.size(), pixels_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            require_finite(picture, i);
            const Rgb& c = picture.pixels[i];
            rgb[3 * i] = code(double{c.r} * gain);
            rgb[3 * i + 1] = code(double{c.g} * gain);
            rgb[3 * i + 2] = code(double{c.b} * gain);
        }
    });
    return rgb;
}

}  // namespace afterglow
