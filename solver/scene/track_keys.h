#pragma once

#include <vector>

#include "solver/base/json.h"
#include "solver/scene/scene.h"

namespace afterglow {

/// How a list of keys in JSON is to be understood.
struct KeyStyle {
    double seconds_per_unit = 1;  ///< of the times
    double metres_per_unit = 1;   ///< of positions
    enum class Interpolation { linear, step } interpolation = Interpolation::linear;
};

/// Keys of the form [time, x, y, z]. Errors of all: invalid_input at the key for times that are negative or
/// decrease and for values that are not finite.
std::vector<Key<Vec3>> position_keys(const JsonView& view, const KeyStyle& style);

/// Keys of the form [time, x, y, z, degrees], a turn about an axis; at most 100 turns. Between two keys about
/// the same axis the angle runs evenly, also past half a turn (by keys put between); about different axes
/// the rotation goes the shortest way.
std::vector<Key<Quat>> rotation_keys(const JsonView& view, const KeyStyle& style);

/// Keys of the form [time, factor], factors from 0.
std::vector<Key<float>> scale_keys(const JsonView& view, const KeyStyle& style);

/// Keys of the form [time, red, green, blue], from 0.
std::vector<Key<Rgb>> colour_keys(const JsonView& view, const KeyStyle& style);

}  // namespace afterglow
