#pragma once

#include <vector>

#include "solver/scene/gltf_document.h"
#include "solver/scene/load.h"
#include "solver/scene/scene.h"

namespace afterglow::gltf {

/// Reads the perspective cameras into the scene. Returns for every camera of the file its place in
/// Scene::cameras, or no_index for an orthographic one, which is left out with a warning.
/// Errors: invalid_input for an angle outside (0, π).
std::vector<Index> read_cameras(const Document& document, Scene& scene);

/// Reads the lights of KHR_lights_punctual into the scene, at the same position as in the file. The extension
/// counts candela and lux; the scene wants W/sr and W/m². Following `scale`, they are divided by the 683 lm/W
/// that Blender's default export multiplies by (all kinds of lights alike), with a warning.
/// Errors: invalid_input for negative intensities, unknown kinds and cones outside 0 ≤ inner < outer ≤ π/2.
void read_lights(const Document& document, LumenScale scale, Scene& scene);

}  // namespace afterglow::gltf
