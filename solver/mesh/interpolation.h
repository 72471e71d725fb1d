#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/mesh/patch_mesh.h"

namespace afterglow {

/// The patches whose values make up the value at a point, and their weights (sum 1, all ≥ 0).
struct Stencil {
    static constexpr std::size_t most = 24;
    std::array<Index, most> patch{};
    std::array<float, most> weight{};
    std::size_t count = 0;

    void add(Index p, float w) {
        if (w <= 0 || count == most) return;
        patch[count] = p;
        weight[count++] = w;
    }
};

/// Smooth values from patch values: on flat surfaces the mean over a window as large as the cell at the
/// point, which between equal cells is bilinear; on curved ones weighted by distance among a cluster and its
/// neighbours. Never crosses the border of a surface, its two sides, or what stands on it.
/// Thread-safety: const after construction; the mesh must outlive it.
class Interpolation {
  public:
    Interpolation(const World& world, const PatchMesh& mesh);

    /// The stencil at a point of a triangle's side, position in the body's frame; empty on sides without
    /// patches.
    [[nodiscard]] Stencil at(Index body, Index triangle, Side side, const Vec3& position) const;

    /// Weighted mean of values, patches counting by their `confidence` too (0: knows nothing).
    [[nodiscard]] static Rgb value(const Stencil& stencil, std::span<const Rgb> values,
                                   std::span<const float> confidence);

  private:
    [[nodiscard]] static Stencil on_grid(const CellTree& tree, const Vec2& at);
    [[nodiscard]] Stencil on_clusters(Index patch, const Vec3& position) const;

    const PatchMesh* mesh_;
    std::vector<std::size_t> first_neighbour_;  // by patch; empty ranges on flat surfaces
    std::vector<Index> neighbours_;
};

}  // namespace afterglow
