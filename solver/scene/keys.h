#pragma once

#include <algorithm>
#include <span>

#include "solver/scene/world.h"

// How a value runs between keys: shared by tracks and paths.

namespace afterglow {

/// The value a share `s` in [0, 1] of the way from `a` to `b`: linear.
inline float mixed(float a, float b, float s) {
    return a + s * (b - a);
}
inline Vec3 mixed(const Vec3& a, const Vec3& b, float s) {
    return a + s * (b - a);
}
/// The same for rotations: spherical, the shorter way round. Source: Shoemake 1985, "Animating rotation with
/// quaternion curves".
inline Quat mixed(const Quat& a, const Quat& b, float s) {
    return a == b ? a : glm::normalize(glm::slerp(a, b, s));
}

inline Pose mixed(const Pose& a, const Pose& b, float s) {
    return {mixed(a.translation, b.translation, s), mixed(a.rotation, b.rotation, s)};
}

/// Which of two values holds where a track jumps.
enum class JumpSide {
    before,  ///< the one the track comes from
    after,   ///< the one it goes on with: what a picture at that time shows
};

/// Value of keys in order of time, constant outside them. `keys` must not be empty. Thread-safety: pure.
template <class T>
T value_in(std::span<const Key<T>> keys, double time_s, JumpSide side = JumpSide::after) {
    const auto earlier = [](const Key<T>& key, double time) { return key.time_s < time; };
    const auto later = [](double time, const Key<T>& key) { return time < key.time_s; };
    const auto next = side == JumpSide::after ? std::upper_bound(keys.begin(), keys.end(), time_s, later)
                                              : std::lower_bound(keys.begin(), keys.end(), time_s, earlier);
    if (next == keys.begin()) return keys.front().value;
    if (next == keys.end()) return keys.back().value;
    const auto previous = next - 1;
    const double share = (time_s - previous->time_s) / (next->time_s - previous->time_s);
    // A key's own value comes back bit for bit.
    if (share <= 0) return previous->value;
    if (share >= 1) return next->value;
    return mixed(previous->value, next->value, static_cast<float>(share));
}

}  // namespace afterglow
