#pragma once

#include <vector>

#include "solver/scene/scene.h"

namespace afterglow {

/// Gives nodes materials of their own, so that changing them changes nothing else. Made once for several
/// nodes of one scene, which nobody else changes meanwhile.
class OwnMaterials {
  public:
    explicit OwnMaterials(Scene& scene);

    /// The materials of a node's mesh, after making copies of those that other nodes use, too. Copies are
    /// named "material of node" and keep the tracks of their originals. Errors: none; empty without a mesh.
    std::vector<Index> of(Index node);

  private:
    [[nodiscard]] std::vector<Index> used_by(Index mesh) const;
    Index copy_of(Index material, Index node);

    Scene& scene_;
    std::vector<std::size_t> nodes_of_mesh_;
    std::vector<std::size_t> meshes_of_material_;  ///< counting only meshes that nodes show
};

}  // namespace afterglow
