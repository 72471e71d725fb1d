#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/mesh/patch_mesh.h"

namespace afterglow {

/// A patch and its share of what is interpolated at a point.
struct PatchWeight {
    Index patch;
    float weight;
};

/// The patches whose values make up the value at a point, and their weights (sum 1, all ≥ 0).
struct Stencil {
    static constexpr std::size_t most = 24;
    std::size_t count = 0;
    std::array<PatchWeight, most>
        entry;  ///< the first `count`; to clear the others would take longer than use

    void add(Index patch, float weight) {
        if (weight > 0 && count < most) entry[count++] = {patch, weight};
    }
    [[nodiscard]] std::span<const PatchWeight> patches() const { return std::span(entry).first(count); }
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
    static void add_on_grid(const CellTree& tree, const Vec2& at, Stencil& stencil);
    void add_on_clusters(Index patch, const Vec3& position, Stencil& stencil) const;

    const PatchMesh* mesh_;
    std::vector<std::size_t> first_neighbour_;  // by patch; empty ranges on flat surfaces
    std::vector<Index> neighbours_;
};

}  // namespace afterglow
