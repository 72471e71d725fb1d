#pragma once

#include <string>
#include <string_view>

#include "solver/scene/load.h"
#include "solver/scene/resources.h"
#include "solver/scene/scene.h"

namespace afterglow {

/// Reads a glTF 2.0 asset: `format` glb or gltf. `name` stands for the file in errors; `read_resource`
/// fetches external buffers and pictures (empty: none allowed).
Scene read_gltf(std::string_view bytes, SceneFormat format, const std::string& name,
                const ResourceReader& read_resource, const LoadConfig& config);

}  // namespace afterglow
