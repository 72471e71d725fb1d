#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "solver/scene/resources.h"
#include "solver/scene/scene.h"

namespace afterglow {

/// What the faces of a material are in the scene.
struct ObjMaterial {
    Index material = no_index;  ///< into Scene::materials
    enum class Kind {
        surface,
        opening,  ///< lets most light through: its faces are left out
    } kind = Kind::surface;
};

/// Reads the material libraries of one .obj file into a scene.
class MtlReader {
  public:
    /// `read_resource` fetches libraries and pictures (empty: none allowed).
    MtlReader(const ResourceReader& read_resource, Scene& scene)
        : read_resource_(read_resource), scene_(scene) {}

    /// Adds the materials of the library `file`. A material that is there already is kept. `place` names the
    /// reference in errors.
    /// Errors: whatever `read_resource` throws; invalid_input with file and line for bad values.
    void read_library(const std::string& file, const std::string& place);

    /// The material of faces that come before any is named: plain grey.
    ObjMaterial plain();

    /// A material by name; added as plain grey, with a warning, where no library has it.
    ObjMaterial named(const std::string& name, const std::string& place);

  private:
    class Library;

    std::string read(const std::string& file, const std::string& place);
    Index texture(const std::string& file, const std::string& place);

    const ResourceReader& read_resource_;
    Scene& scene_;
    std::map<std::string, ObjMaterial> materials_;
    std::map<std::string, Index> textures_;
    std::uint64_t texels_ = 0;
};

}  // namespace afterglow
