#pragma once

#include "solver/scene/scene.h"

namespace afterglow {

/// A longer animation is refused: at 24 frames a second this is half a day.
inline constexpr double max_frames = 1e6;

/// Checks that every track has a target that exists and no other track of its kind has, at least one key,
/// times from 0 that never decrease, and values in range (rotations of unit length; reflectance may be 1 or
/// more, which `validate` judges); that the frame rate is in (0, 1000]; and that the animation has at most
/// `max_frames` frames. Errors: invalid_input or too_large naming the target and the key.
void check_tracks(const Scene& scene);

/// Time of the last key of all tracks; 0 without any.
double last_key_time(const Tracks& tracks);

}  // namespace afterglow
