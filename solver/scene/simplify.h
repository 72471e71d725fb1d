#pragma once

#include <span>
#include <vector>

#include "solver/scene/load.h"
#include "solver/scene/scene.h"
#include "solver/scene/world.h"

namespace afterglow {

/// Deviation at which keys of emission and reflectance are merged, relative to the track's largest value.
inline constexpr double collinear_tolerance_relative = 1e-4;

/// Leaves out keys that the straight run between their neighbours reproduces: exporters write one key a
/// frame, while a motion segment needs only its two ends.
///
/// From each kept key the furthest key is sought that can follow it such that every key left out lies within
/// the tolerance of the new segment (galloping, then bisection: n log n tests). Kept keys keep their bits, so
/// deviations do not add up. Never merged: both keys of a jump, and the first and last key of a run of equal
/// values (so that what rests, rests exactly). A track whose keys all lie within the tolerance of its first
/// becomes that one key.
///
/// `keys`: at least one, times never decreasing. `tolerance`: metres; radians; or the value's own unit.
/// Thread-safety: pure.
std::vector<Key<Vec3>> simplified(std::span<const Key<Vec3>> keys, double tolerance);
std::vector<Key<Quat>> simplified(std::span<const Key<Quat>> keys, double tolerance_rad);
std::vector<Key<float>> simplified(std::span<const Key<float>> keys, double tolerance);
std::vector<Key<Pose>> simplified(std::span<const Key<Pose>> keys, double tolerance_m, double tolerance_rad);

/// Simplifies every track of a scene. Errors: invalid_input for a negative or non-finite tolerance.
void simplify_tracks(Tracks& tracks, const LoadConfig& config);

/// Angle in radians between two rotations, in [0, π]. Accurate for small angles, unlike an arc cosine.
double angle_between(const Quat& a, const Quat& b);

}  // namespace afterglow
