#pragma once

#include <cstddef>
#include <vector>

#include "solver/base/json.h"

namespace afterglow {

/// The numbers of an array of arrays, row after row: `columns` finite numbers in each. For long lists: a view
/// of each number is made only where one is wrong. Errors: invalid_input naming the row or the number.
std::vector<double> number_rows(const JsonView& view, std::size_t columns);

/// A number from JSON as single precision. Errors: invalid_input where it is too large.
float to_single(const JsonView& view, double number);

/// A colour or radiance: three numbers, or one for a grey. Errors: invalid_input where negative.
Rgb as_rgb(const JsonView& view);

/// A rotation as [x, y, z, degrees]: about an axis, counter-clockwise seen from its tip.
/// Errors: invalid_input for an axis of length 0.
Quat as_rotation(const JsonView& view);

}  // namespace afterglow
