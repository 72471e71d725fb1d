#pragma once

#include <span>
#include <vector>

#include "solver/mesh/cuts.h"
#include "solver/mesh/patch_mesh.h"

namespace afterglow {

/// The shapes of one side of a surface and how to find them.
struct SurfaceShapes {
    SurfaceGrid grid;
    CellTree tree;                   ///< flat: items are indices into `shapes`
    std::vector<PatchShape> shapes;  ///< neighbours near each other, so that runs of 16 are compact
    std::vector<std::vector<Index>> triangles;  ///< curved: what each shape is made of, of the body
};

/// A side of a flat surface and what stands on it.
struct SurfaceSide {
    Side side = Side::front;
    std::span<const Cut> cuts;
    float lift_m = 0;  ///< see lift_for
};

/// A side of a flat surface as a grid of cells no longer than the asked size, clipped to its triangles, in
/// 4 × 4 tiles; cells that are too coarse are halved both ways, again and again, and then split along cuts.
SurfaceShapes divide_flat(const World& world, const Surface& surface, const SurfaceSide& on,
                          const MeshConfig& config);

/// A curved surface as clusters of connected triangles about `size_m` across.
SurfaceShapes divide_curved(const World& world, const Surface& surface, float size_m);

/// Mean texture colour over a triangle given by texture coordinates.
Rgb mean_texture(const Texture& texture, const std::array<Vec2, 3>& corners);

}  // namespace afterglow
