#pragma once

#include <vector>

#include "solver/scene/gltf_document.h"
#include "solver/scene/gltf_materials.h"
#include "solver/scene/scene.h"

namespace afterglow::gltf {

/// Reads every mesh into the scene, at the same position as in the file, all primitives of a mesh joined.
/// `surfaces`: as read_materials returned them. Points, lines and openings are left out; strips and fans
/// become triangles; vertex colours, skins and morph targets are ignored with a warning. Geometry without a
/// material gets one of default_reflectance, added behind the file's own.
/// Errors: invalid_input for indices out of range and incomplete triangles; too_large past max_vertices or
/// max_triangles; as read_floats.
void read_meshes(const Document& document, const std::vector<Surface>& surfaces, Scene& scene);

}  // namespace afterglow::gltf
