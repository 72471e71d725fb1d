#pragma once

#include <string>
#include <string_view>

#include "solver/scene/load.h"
#include "solver/scene/resources.h"
#include "solver/scene/scene.h"

namespace afterglow {

/// Reads a scene of Afterglow's own JSON format (docs/scene-format.md). `name` stands for the file in errors;
/// `read_resource` fetches the geometry files and pictures that it names (empty: none allowed); `config` says
/// how they are read.
/// Errors: invalid_input with the JSON pointer for unknown fields, wrong types and names that nothing has;
/// those of the files named, with the pointer of the reference.
Scene read_json_scene(std::string_view text, const std::string& name, const ResourceReader& read_resource,
                      const LoadConfig& config);

}  // namespace afterglow
