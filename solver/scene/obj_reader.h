#pragma once

#include <string>
#include <string_view>

#include "solver/scene/load.h"
#include "solver/scene/resources.h"
#include "solver/scene/scene.h"

namespace afterglow {

/// Reads a Wavefront .obj file and the libraries it names: vertices, texture coordinates and polygons; each
/// object or group becomes a node; normals are not needed and curves, lines and points are left out with a
/// warning. `config` gives the length of a unit and the axis that points up. The scene has no camera.
/// `name` stands for the file in errors; `read_resource` fetches libraries and pictures (empty: none
/// allowed).
/// Errors: invalid_input, too_large with "file:line"; what `read_resource` throws, with the line.
/// Thread-safety: pure apart from `read_resource`.
Scene read_obj(std::string_view text, const std::string& name, const ResourceReader& read_resource,
               const LoadConfig& config);

}  // namespace afterglow
