#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "solver/base/json.h"
#include "solver/scene/names.h"
#include "solver/scene/scene.h"

namespace afterglow {

/// Brings the geometry of other files into a scene. A file's meshes, materials and textures come once,
/// however often it is placed; its cameras and lights do not come.
class SceneIncluder {
  public:
    /// The first `own_materials` of `scene`'s materials take the place of those of the same name in files.
    explicit SceneIncluder(Scene& scene);

    /// The place of a file in the includer, after adding its parts. `warnings` of the file come along.
    std::size_t add_file(Scene file);

    /// Puts a file's nodes below `parent`, with their tracks; `prefix`/ comes before their names. `only`: the
    /// node named there and what hangs on it, as a document asks. Errors: invalid_input at `only` for a name
    /// that no or more than one node of the file has; `where` for a file that shows no triangles.
    void place(std::size_t file, Index parent, const std::string& prefix, const JsonView* only,
               const JsonView& where);

  private:
    /// A file whose parts are in the scene already.
    struct File {
        std::vector<Node> nodes;  ///< their meshes are numbers in the scene
        Tracks tracks;            ///< of its own node numbers; materials' tracks are in the scene already
    };
    void add_material_tracks(const Tracks& tracks, const std::vector<Index>& materials);

    Scene& scene_;
    std::size_t own_materials_;
    std::unordered_map<std::string, Index> own_by_name_;
    std::vector<File> files_;
};

}  // namespace afterglow
