#pragma once

#include <span>
#include <vector>

#include "solver/mesh/patch_mesh.h"

namespace afterglow {

/// A patch before it is given a side and a number; normals are those of the front.
struct PatchShape {
    float area_m2 = 0;
    Vec3 centre{0}, normal{0};
    Vec3 origin{0}, edge_u{0}, edge_v{0};  ///< where it is a whole rectangle
    std::vector<Fragment> fragments;       ///< otherwise
    Rgb texture_mean{1};
    std::size_t cell = 0;          ///< flat: v · cells_u + u
    std::vector<Index> triangles;  ///< curved: what it is made of, of the body
};

/// The shapes of one surface and how to find them.
struct SurfaceShapes {
    SurfaceGrid grid;
    std::vector<PatchShape> shapes;  ///< neighbours near each other, so that runs of 16 are compact
};

/// A flat surface as a grid of cells no longer than `size_m`, clipped to its triangles; in 4 × 4 tiles.
SurfaceShapes divide_flat(const World& world, const Surface& surface, float size_m);

/// A curved surface as clusters of connected triangles about `size_m` across.
SurfaceShapes divide_curved(const World& world, const Surface& surface, float size_m);

/// Mean texture colour over a triangle given by texture coordinates.
Rgb mean_texture(const Texture& texture, const std::array<Vec2, 3>& corners);

}  // namespace afterglow
