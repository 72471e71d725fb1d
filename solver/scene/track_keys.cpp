#include "solver/scene/track_keys.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "solver/scene/json_rows.h"

namespace afterglow {

namespace {

constexpr double max_degrees = 36'000;
constexpr double max_time_s = 1e9;

/// Reads rows of a time and `columns` numbers; `value(numbers)` makes the value of a key.
template <class T, class MakeValue>
std::vector<Key<T>> read_keys(const JsonView& view, const KeyStyle& style, std::size_t columns,
                              const MakeValue& value) {
    const auto rows = number_rows(view, columns + 1);
    if (rows.empty()) view.fail("a track needs at least one key");
    std::vector<Key<T>> keys;
    const bool steps = style.interpolation == KeyStyle::Interpolation::step;
    for (std::size_t row = 0; row < rows.size(); row += columns + 1) {
        const auto fail = [&](const std::string& message) {
            view.elements()[row / (columns + 1)].fail(message);
        };
        const double time = rows[row] * style.seconds_per_unit;
        if (!(time >= 0) || time > max_time_s) fail("the time must be from 0 to 1e9 seconds");
        if (!keys.empty() && time < keys.back().time_s) fail("is earlier than the key before it");
        const auto made = value(&rows[row + 1], fail);
        // What steps holds its value up to the next key and jumps there.
        if (steps && !keys.empty()) keys.push_back({time, keys.back().value});
        keys.push_back({time, made});
    }
    return keys;
}

Vec3 vec3_of(const double* numbers, double factor) {
    return {static_cast<float>(numbers[0] * factor), static_cast<float>(numbers[1] * factor),
            static_cast<float>(numbers[2] * factor)};
}

/// A turn about an axis of length 1.
struct Turn {
    glm::dvec3 axis{0, 1, 0};
    double degrees = 0;

    [[nodiscard]] Quat rotation() const {
        return glm::normalize(Quat(glm::angleAxis(glm::radians(degrees), axis)));
    }
};

/// Puts keys between two turns about one axis, at most a quarter turn apart, so that the shorter way from
/// each to the next is the way meant.
void add_between(std::vector<Key<Quat>>& out, const Key<Turn>& from, const Key<Turn>& to) {
    const double degrees = to.value.degrees - from.value.degrees;
    const bool same_axis = glm::dot(from.value.axis, to.value.axis) > 1 - 1e-12;
    if (!same_axis || std::abs(degrees) < 180 || from.time_s == to.time_s) return;
    const int parts = static_cast<int>(std::ceil(std::abs(degrees) / 90));
    for (int part = 1; part < parts; ++part) {
        const double share = static_cast<double>(part) / parts;
        const Turn turn{to.value.axis, from.value.degrees + share * degrees};
        out.push_back({from.time_s + share * (to.time_s - from.time_s), turn.rotation()});
    }
}

}  // namespace

std::vector<Key<Vec3>> position_keys(const JsonView& view, const KeyStyle& style) {
    return read_keys<Vec3>(view, style, 3, [&](const double* numbers, const auto& fail) {
        const Vec3 position = vec3_of(numbers, style.metres_per_unit);
        if (!is_finite(position)) fail("a number is too large for single precision");
        return position;
    });
}

std::vector<Key<Quat>> rotation_keys(const JsonView& view, const KeyStyle& style) {
    const auto turns = read_keys<Turn>(view, style, 4, [](const double* numbers, const auto& fail) {
        const glm::dvec3 axis(numbers[0], numbers[1], numbers[2]);
        const double length = glm::length(axis);
        if (!(length > 0) || !std::isfinite(length)) fail("the axis has no direction");
        if (std::abs(numbers[3]) > max_degrees) fail("turns more than 100 times");
        return Turn{axis / length, numbers[3]};
    });
    std::vector<Key<Quat>> keys;
    for (std::size_t k = 0; k < turns.size(); ++k) {
        if (k > 0) add_between(keys, turns[k - 1], turns[k]);
        keys.push_back({turns[k].time_s, turns[k].value.rotation()});
    }
    return keys;
}

std::vector<Key<float>> scale_keys(const JsonView& view, const KeyStyle& style) {
    return read_keys<float>(view, style, 1, [](const double* numbers, const auto& fail) {
        const auto scale = static_cast<float>(numbers[0]);
        if (!(scale >= 0) || !std::isfinite(scale)) fail("a factor must be from 0");
        return scale;
    });
}

std::vector<Key<Rgb>> colour_keys(const JsonView& view, const KeyStyle& style) {
    return read_keys<Rgb>(view, style, 3, [](const double* numbers, const auto& fail) {
        const Rgb colour = vec3_of(numbers, 1);
        if (!is_finite(colour) || std::min({colour.r, colour.g, colour.b}) < 0)
            fail("a colour must be from 0");
        return colour;
    });
}

}  // namespace afterglow
