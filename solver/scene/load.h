#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "solver/scene/scene.h"

namespace afterglow {

enum class UpAxis { y, z };
/// Blender's default glTF export multiplies punctual lights by 683 lm/W and leaves emission alone.
enum class LumenScale {
    automatic,  ///< divide punctual lights by 683 when the file's generator says Blender
    keep,       ///< take the numbers as they stand
    divide,     ///< always divide
};

/// How a file is read; the defaults suit Blender.
struct LoadConfig {
    double obj_unit_m = 1.0;                         ///< metres in one unit of an .obj file
    UpAxis obj_up = UpAxis::y;                       ///< which axis of an .obj file points up
    LumenScale lumen_scale = LumenScale::automatic;  ///< punctual lights of glTF files
    double collinear_tolerance_m = 1e-4;    ///< position keys this near a straight line in time are merged
    double collinear_tolerance_rad = 1e-4;  ///< the same for rotations
    std::optional<Rgb> background;          ///< replaces the scene's own background radiance
};

/// What the bytes of a scene are; a bundle is a scene with the files it refers to, see bundle.h.
enum class SceneFormat { glb, gltf, obj, json, bundle };

/// The format a file name's ending stands for. Errors: unsupported, naming the endings that are read.
SceneFormat format_of(const std::filesystem::path& path);

/// Reads a scene file and whatever it refers to inside its own folder, then validates it.
/// Errors: every problem is an Error that names the file and the JSON pointer, line or node; see
/// docs/scene-format.md.
Scene load_scene(const std::filesystem::path& path, const LoadConfig& config = {});

/// Reads a scene from memory, as uploaded. `name` stands for it in errors, for a bundle its scene's own name.
/// References to files that are not in it are errors.
Scene read_scene(std::string_view bytes, SceneFormat format, const std::string& name,
                 const LoadConfig& config = {});

/// Adds the tracks of a paths document to a scene; a track for the same target and property is replaced.
/// `name` stands for the text in errors. Errors: invalid_input with the JSON pointer; the scene is then
/// unchanged.
void apply_paths(Scene& scene, std::string_view json_text, const std::string& name,
                 const LoadConfig& config = {});

/// Checks every invariant of Scene, drops what has no area and says so, and adds what must not be missing (a
/// default camera). Errors: invalid_input for indices out of range, non-finite numbers, reflectance at or
/// above 1 in a closed scene, no light at all.
void validate(Scene& scene);

}  // namespace afterglow
