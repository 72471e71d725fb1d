#include "solver/scene/json_rows.h"

#include <algorithm>
#include <cmath>

namespace afterglow {

std::vector<double> number_rows(const JsonView& view, std::size_t columns) {
    const Json& rows = view.value();
    if (!rows.is_array()) view.fail("expected an array of rows of numbers");
    const auto is_finite_number = [](const Json& number) {
        return number.is_number() && std::isfinite(number.get<double>());
    };
    std::vector<double> out;
    out.reserve(rows.size() * columns);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const Json& numbers = rows[row];
        // The slow way says what is wrong, and where.
        if (!numbers.is_array() || numbers.size() != columns ||
            !std::all_of(numbers.begin(), numbers.end(), is_finite_number))
            static_cast<void>(view.elements()[row].as_numbers(columns));
        for (const Json& number : numbers) out.push_back(number.get<double>());
    }
    return out;
}

float to_single(const JsonView& view, double number) {
    const auto out = static_cast<float>(number);
    if (!std::isfinite(out)) view.fail("the number is too large for single precision");
    return out;
}

Rgb as_rgb(const JsonView& view) {
    const Rgb out = view.value().is_number() ? Rgb(to_single(view, view.as_number())) : view.as_vec3();
    if (std::min({out.r, out.g, out.b}) < 0) view.fail("must not be negative");
    return out;
}

Quat as_rotation(const JsonView& view) {
    const auto numbers = view.as_numbers(4);
    const glm::dvec3 axis(numbers[0], numbers[1], numbers[2]);
    const double length = glm::length(axis);
    if (!(length > 0) || !std::isfinite(length)) view.fail("the axis has no direction");
    return Quat(glm::angleAxis(glm::radians(numbers[3]), axis / length));
}

}  // namespace afterglow
