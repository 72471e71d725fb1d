#pragma once

#include <optional>
#include <vector>

#include "solver/scene/gltf_document.h"
#include "solver/scene/gltf_textures.h"
#include "solver/scene/scene.h"

namespace afterglow::gltf {

/// What a mesh must know of a material.
struct Surface {
    enum class Kind {
        solid,
        opening,  ///< so transparent that its triangles are left out
    } kind = Kind::solid;
    std::optional<TextureUse> base_colour;
};

/// Reads every material into the scene, at the same position as in the file; returns one Surface for each.
/// Reflectance is the base colour as it stands (validate() clamps), emission is emissive factor × strength.
/// A material is an opening where it does not emit and is transmissive by more than a half, blends with an
/// alpha below a half, or is masked by its own alpha. Whatever is not diffuse gets a warning.
/// Errors: invalid_input for wrong types or ranges; as TextureReader.
std::vector<Surface> read_materials(const Document& document, Scene& scene);

/// Reflectance of geometry that names no material: what Blender shows it in. The specification's default, a
/// perfectly white metal, would let no light ever die.
inline constexpr float default_reflectance = 0.8F;

}  // namespace afterglow::gltf
