#pragma once

#include <map>
#include <optional>

#include "solver/scene/gltf_document.h"
#include "solver/scene/scene.h"

namespace afterglow::gltf {

/// How a material looks up a texture.
struct TextureUse {
    Index texture = no_index;  ///< into Scene::textures
    Index coordinates = 0;     ///< n of the attribute TEXCOORD_n
    Vec2 offset{0};            ///< KHR_texture_transform: uv' = offset + rotation · (scale · uv)
    Vec2 scale{1};
    float rotation = 0;   ///< radians, counter-clockwise
    bool repeats = true;  ///< false where the file asks for clamping or mirroring instead

    [[nodiscard]] Vec2 transformed(const Vec2& uv) const;
};

/// Decodes pictures once each and puts them into the scene.
class TextureReader {
  public:
    TextureReader(const Document& document, Scene& scene) : document_(document), scene_(scene) {}

    /// Reads a textureInfo object ("index", "texCoord", extensions). Nothing, with a warning, where the
    /// texture has no picture that we can use.
    /// Errors: invalid_input for a damaged picture; too_large past max_texels in all.
    std::optional<TextureUse> read(const JsonView& texture_info);

    /// Mean linear colour of the picture of a textureInfo object, which is not kept. White where there is
    /// none. Errors: as read.
    Rgb mean_colour(const JsonView& texture_info);

  private:
    /// The picture of a textureInfo as an index into "images"; nothing, with a warning, where there is none.
    std::optional<Index> picture_of(const JsonView& texture_info);
    Texture decode(Index picture);

    const Document& document_;
    Scene& scene_;
    std::map<Index, Index> decoded_;  ///< picture → texture of the scene
    std::map<Index, Rgb> means_;      ///< picture → mean colour
    std::size_t texels_ = 0;          ///< decoded so far
};

}  // namespace afterglow::gltf
