#pragma once

#include "solver/scene/scene.h"
#include "solver/sequence/sequence.h"

namespace afterglow::testing {

/// All pictures of one frame, coarse ones first, by a whole sequence.
std::vector<Picture> pictures_of(World world, const SequenceConfig& config, int frame = 0);

/// What is wrong with a picture's pixels: the first that is not finite or below 0, and how many there are.
/// Empty where all is well.
std::string faults_of(const Picture& picture);

/// The largest channel of all pixels.
float brightest(const Picture& picture);

/// A world's geometry, lights and cameras as a scene, as a reader would hand it over.
Scene scene_of(const World& world);

/// A world through the front door: checked, cleaned and put together anew, as if it came from a file. Errors:
/// as `validate`.
World from_file(const World& world);

}  // namespace afterglow::testing
