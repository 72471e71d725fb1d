#include "solver/scene/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "solver/scene/keys.h"

namespace afterglow {

namespace {

/// Without keys that can never show: repeats of the key before, and all but the first and last of one time.
template <class T>
std::vector<Key<T>> without_repeats(std::span<const Key<T>> keys) {
    std::vector<Key<T>> out;
    for (const auto& key : keys) {
        const auto n = out.size();
        if (n >= 2 && out[n - 2].time_s == key.time_s) out.pop_back();
        if (!out.empty() && out.back().time_s == key.time_s && out.back().value == key.value) continue;
        out.push_back(key);
    }
    return out;
}

/// True where key k must stay: part of a jump, or the end of a run of equal values.
template <class T>
bool is_pinned(std::span<const Key<T>> keys, std::size_t k) {
    const auto& [before, here, after] = std::tie(keys[k - 1], keys[k], keys[k + 1]);
    if (before.time_s == here.time_s || here.time_s == after.time_s) return true;
    return (before.value == here.value) != (here.value == after.value);
}

/// True where all keys strictly between `first` and `last` are near the straight run between those two.
template <class T, class Near>
bool is_straight(std::span<const Key<T>> keys, std::size_t first, std::size_t last, const Near& near) {
    const std::array<Key<T>, 2> ends{keys[first], keys[last]};
    for (std::size_t k = first + 1; k < last; ++k)
        if (!near(value_in<T>(ends, keys[k].time_s), keys[k].value)) return false;
    return true;
}

/// The furthest key, at most `limit`, that a straight run from `first` reaches.
template <class T, class Near>
std::size_t furthest(std::span<const Key<T>> keys, std::size_t first, std::size_t limit, const Near& near) {
    std::size_t good = first + 1;
    std::size_t bad = limit + 1;
    while (good < limit && bad > limit) {
        const std::size_t next = std::min(limit, first + 2 * (good - first));
        (is_straight(keys, first, next, near) ? good : bad) = next;
    }
    while (bad <= limit && bad - good > 1) {
        const std::size_t middle = good + (bad - good) / 2;
        (is_straight(keys, first, middle, near) ? good : bad) = middle;
    }
    return good;
}

template <class T, class Near>
std::vector<Key<T>> merged(std::span<const Key<T>> given, const Near& near) {
    const auto all = without_repeats(given);
    const std::span<const Key<T>> keys(all);
    const auto is_like_first = [&](const Key<T>& key) { return near(keys[0].value, key.value); };
    if (std::all_of(keys.begin(), keys.end(), is_like_first)) return {keys[0]};
    std::vector<Key<T>> out{keys[0]};
    std::size_t limit = 0;
    for (std::size_t k = 0; k + 1 < keys.size();) {
        if (limit <= k)
            for (limit = k + 1; limit + 1 < keys.size() && !is_pinned(keys, limit);) ++limit;
        k = furthest(keys, k, limit, near);
        out.push_back(keys[k]);
    }
    return out;
}

double largest(const std::vector<Key<Vec3>>& keys) {
    double out = 0;
    for (const auto& key : keys) out = std::max(out, static_cast<double>(max_channel(glm::abs(key.value))));
    return out;
}

double largest(const std::vector<Key<float>>& keys) {
    double out = 0;
    for (const auto& key : keys) out = std::max(out, std::abs(static_cast<double>(key.value)));
    return out;
}

double distance_between(const Vec3& a, const Vec3& b) {
    return static_cast<double>(glm::length(a - b));
}

}  // namespace

double angle_between(const Quat& a, const Quat& b) {
    // A quaternion and its negative are one rotation: the nearer of the two counts.
    const auto chord = [&](float sign) {
        const glm::dvec4 d(a.w - sign * b.w, a.x - sign * b.x, a.y - sign * b.y, a.z - sign * b.z);
        return glm::length(d);
    };
    return 4 * std::asin(std::min(1.0, std::min(chord(1), chord(-1)) / 2));
}

std::vector<Key<Vec3>> simplified(std::span<const Key<Vec3>> keys, double tolerance) {
    return merged(keys, [=](const Vec3& a, const Vec3& b) { return distance_between(a, b) <= tolerance; });
}

std::vector<Key<Quat>> simplified(std::span<const Key<Quat>> keys, double tolerance_rad) {
    return merged(keys, [=](const Quat& a, const Quat& b) { return angle_between(a, b) <= tolerance_rad; });
}

std::vector<Key<float>> simplified(std::span<const Key<float>> keys, double tolerance) {
    return merged(keys, [=](float a, float b) { return std::abs(static_cast<double>(a) - b) <= tolerance; });
}

std::vector<Key<Pose>> simplified(std::span<const Key<Pose>> keys, double tolerance_m, double tolerance_rad) {
    return merged(keys, [=](const Pose& a, const Pose& b) {
        return distance_between(a.translation, b.translation) <= tolerance_m &&
               angle_between(a.rotation, b.rotation) <= tolerance_rad;
    });
}

void simplify_tracks(Tracks& tracks, const LoadConfig& config) {
    for (const double tolerance : {config.collinear_tolerance_m, config.collinear_tolerance_rad})
        if (!std::isfinite(tolerance) || tolerance < 0)
            throw Error(ErrorKind::invalid_input, "collinear tolerance", "must be a finite number from 0");
    for (auto& track : tracks.node_translation)
        track.keys = simplified(track.keys, config.collinear_tolerance_m);
    for (auto& track : tracks.node_rotation)
        track.keys = simplified(track.keys, config.collinear_tolerance_rad);
    for (auto& track : tracks.material_emission)
        track.keys = simplified(track.keys, collinear_tolerance_relative * largest(track.keys));
    for (auto& track : tracks.material_reflectance)
        track.keys = simplified(track.keys, collinear_tolerance_relative * largest(track.keys));
}

}  // namespace afterglow
