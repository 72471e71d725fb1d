#pragma once

#include <vector>

#include "solver/scene/gltf_document.h"
#include "solver/scene/scene.h"

namespace afterglow::gltf {

/// Reads the hierarchy of the default scene (or the first, or all roots where the file has no scene) into the
/// scene, parents before children. Cameras, lights and meshes are referred to by the file's numbers, so
/// they must be in the scene at those positions already; cameras for which `cameras` holds no_index are left
/// out. Returns for every node of the file its place in Scene::nodes, or no_index for nodes outside the
/// scene. Errors: invalid_input for cycles, nodes with two parents, indices out of range, and matrices with
/// shear.
std::vector<Index> read_nodes(const Document& document, const std::vector<Index>& cameras, Scene& scene);

/// Translation, rotation and scale of a 4×4 matrix given column by column. `place` names it in errors.
/// Errors: invalid_input for a last row other than 0 0 0 1, for shear, and for a matrix that flattens space.
Transform decomposed(const std::vector<double>& matrix, const JsonView& place);

/// A rotation given as x, y, z, w, brought to unit length.
/// Errors: invalid_input where the length is off by more than a tenth.
Quat to_rotation(double x, double y, double z, double w, const JsonView& place);

}  // namespace afterglow::gltf
