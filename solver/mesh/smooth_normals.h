#pragma once

#include <array>
#include <vector>

#include "solver/mesh/surface.h"

namespace afterglow {

/// Normals that run smoothly over curved surfaces, for shading only: facets stand for a round shape there.
/// Thread-safety: const after construction.
class SmoothNormals {
  public:
    /// Area-weighted means of the facets around each vertex, within one surface.
    SmoothNormals(const World& world, const Surfaces& surfaces);

    /// Unit normal of a triangle's front at barycentric weights (u, v) of its second and third vertex, in the
    /// body's frame; on flat surfaces the triangle's own.
    [[nodiscard]] Vec3 at(Index body, Index triangle, float u, float v) const;

  private:
    std::vector<std::vector<std::array<Vec3, 3>>> corners_;  // [body][triangle]; empty: a body without curves
    const World* world_;
};

}  // namespace afterglow
