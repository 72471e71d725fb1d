#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace afterglow::client {

/// A scene and the files beside it that it refers to: path with slashes, relative to the scene's folder →
/// content.
using SceneFiles = std::map<std::string, std::string>;

/// Reads the files that a scene refers to, and those that these refer to: buffers and pictures of .gltf and
/// .glb, libraries and pictures of .obj, models and pictures of .json. Only files inside the scene's folder
/// are taken, whatever a scene says, also by way of links; what is missing or outside is left out, for the
/// server to judge. `bytes` is the scene's own content; it is in the result. Errors: bad_input for a file
/// that is there but cannot be read.
SceneFiles collect_scene_files(const std::filesystem::path& scene, const std::string& bytes);

}  // namespace afterglow::client
