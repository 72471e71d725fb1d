#pragma once

#include <vector>

#include "solver/scene/gltf_document.h"
#include "solver/scene/scene.h"

namespace afterglow::gltf {

/// Reads all animations of the file into the scene's tracks, one key for every key of the file; they play
/// together from time 0. `places`: as read_nodes returned them. Sets frames_per_second by
/// frame_rate_of, moves key times onto those frames (single precision puts them a hair beside), and sets
/// duration_s to the last key's time.
/// LINEAR keys are kept; a STEP becomes two keys at one time; CUBICSPLINE is sampled once a frame, with a
/// warning. Scale tracks are replaced by their first value and morph weights left out, with a warning.
/// Channels without a node, or for nodes outside the scene, are skipped with a warning; of two channels for
/// the same property of a node the later one wins, with a warning.
/// Errors: invalid_input for nodes out of range, decreasing, negative or huge times, and outputs that do not
/// match them; too_large past max_keys; as read_floats.
void read_animations(const Document& document, const std::vector<Index>& places, Scene& scene);

/// Frames per second, and whether the key times lie on its frames.
struct FrameRate {
    double frames_per_second = 24;
    bool keys_on_frames = false;
};

/// The first of 24, 25, 30, 48, 50 and 60 frames per second for which every time (seconds) is a whole number
/// of frames within a thousandth of a frame and a millionth of the time; otherwise 24. Thread-safety: pure.
FrameRate frame_rate_of(const std::vector<double>& times_s);

}  // namespace afterglow::gltf
