#pragma once

#include <string>
#include <string_view>

#include "solver/scene/load.h"
#include "solver/scene/resources.h"
#include "solver/scene/scene.h"

namespace afterglow {

/// Reads a glTF 2.0 asset into a scene, before validation. Purpose: what Blender and other modellers export.
/// `format`: glb or gltf. `name` stands for the file in errors and becomes Scene::name. `read_resource`
/// fetches external buffers and pictures (empty: none allowed). `bytes` is not needed afterwards.
///
/// What is read: the default scene's nodes, triangles, base colours with textures, emission, cameras,
/// punctual lights, and translations and rotations over time; see the headers gltf_*.h for the rules. What
/// has no place in a scene of diffuse surfaces is left out or interpreted, each time with a warning.
/// Times of keys give the frame rate: 24, or the first of 25, 30, 48, 50, 60 on whose frames they all lie.
/// Errors: Error naming the file and the JSON pointer: invalid_input, unsupported (another version, unknown
/// required extensions), not_found and io (external files), too_large (the ceilings of gltf_document.h).
/// Thread-safety: may be called from several threads at once.
/// Source: Khronos glTF 2.0 specification.
///
/// Why not tinygltf: the version that Debian 12 packages (2.7) reads files outside the scene's folder,
/// overflows the stack on deeply nested JSON, and takes an accessor's count on trust. Uploaded scenes come
/// from strangers, and the part of glTF that a diffuse scene needs is small.
Scene read_gltf(std::string_view bytes, SceneFormat format, const std::string& name,
                const ResourceReader& read_resource, const LoadConfig& config);

}  // namespace afterglow
