#include "solver/mesh/interpolation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/mesh/adjacency.h"

namespace afterglow {

namespace {

using Neighbours = std::vector<std::pair<Index, Index>>;

/// Pairs of clusters of one body's side that share an edge within a curved surface.
void add_cluster_neighbours(const PatchMesh& mesh, Index body, const Adjacency& adjacency,
                            Neighbours& pairs) {
    const auto& surface_of = mesh.surfaces.of_triangle[body];
    for (const auto& patch_of : mesh.patch_of_triangle[body]) {
        for (Index t = 0; t < patch_of.size(); ++t) {
            if (patch_of[t] == no_index) continue;
            for (std::size_t k = adjacency.begin[t]; k < adjacency.begin[t + 1]; ++k) {
                const Index other = adjacency.neighbour[k];
                if (surface_of[other] == surface_of[t] && patch_of[other] != patch_of[t] &&
                    patch_of[other] != no_index)
                    pairs.emplace_back(patch_of[t], patch_of[other]);
            }
        }
    }
}

void normalise(Stencil& stencil) {
    float sum = 0;
    for (const PatchWeight& entry : stencil.patches()) sum += entry.weight;
    for (std::size_t k = 0; k < stencil.count; ++k) stencil.entry[k].weight /= sum;
}

}  // namespace

Interpolation::Interpolation(const World& world, const PatchMesh& mesh) : mesh_(&mesh) {
    Neighbours pairs;
    for (Index b = 0; b < world.bodies.size(); ++b) {
        const bool curved =
            std::any_of(mesh.surfaces.list.begin(), mesh.surfaces.list.end(),
                        [&](const Surface& s) { return s.body == b && s.kind == Surface::Kind::curved; });
        if (curved) add_cluster_neighbours(mesh, b, find_adjacency(world.bodies[b]), pairs);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    first_neighbour_.assign(mesh.size() + 1, 0);
    for (const auto& [from, to] : pairs) {
        ++first_neighbour_[from + 1];
        neighbours_.push_back(to);
    }
    std::partial_sum(first_neighbour_.begin(), first_neighbour_.end(), first_neighbour_.begin());
}

Stencil Interpolation::at(Index body, Index triangle, Side side, const Vec3& position) const {
    const Index surface = mesh_->surfaces.of_triangle[body][triangle];
    const SurfaceGrid& grid = mesh_->grids[surface];
    const auto which = static_cast<std::size_t>(side);
    Stencil stencil;
    if (grid.cells_u > 0) {
        if (const CellTree& tree = mesh_->trees[surface][which]; !tree.empty())
            add_on_grid(tree, grid.cell_at(position), stencil);
    } else if (const Index patch = mesh_->patch_of_triangle[body][which][triangle]; patch != no_index) {
        add_on_clusters(patch, position, stencil);
    }
    if (stencil.count == 0) {
        const Index patch = mesh_->patch_at(body, triangle, side, position);
        if (patch != no_index) stencil.add(patch, 1);
    }
    return stencil;
}

void Interpolation::add_on_grid(const CellTree& tree, const Vec2& at, Stencil& stencil) {
    const Vec2 end(tree.cells_u, tree.cells_v);
    const Vec2 place = glm::clamp(at, Vec2(0), end);
    const float reach = 0.5F * tree.leaf_at(place).size;
    tree.for_overlaps(place - reach, place + reach, [&](Index patch, float area, const Vec2& centre) {
        if (!tree.is_divided_between(place, centre)) stencil.add(patch, area);
    });
    if (stencil.count > 0) normalise(stencil);
}

void Interpolation::add_on_clusters(Index patch, const Vec3& position, Stencil& stencil) const {
    // The kernel reaches as far as the farthest neighbour's centre, where its weight falls to zero.
    float reach = 0;
    for (std::size_t k = first_neighbour_[patch]; k < first_neighbour_[patch + 1]; ++k)
        reach = std::max(reach, glm::length(mesh_->centre[neighbours_[k]] - mesh_->centre[patch]));
    if (reach <= 0) {
        stencil.add(patch, 1);
        return;
    }
    const auto add = [&](Index p) {
        const Vec3 d = position - mesh_->centre[p];
        const float share = std::max(0.0F, 1 - glm::dot(d, d) / (reach * reach));
        stencil.add(p, mesh_->area_m2[p] * share * share);
    };
    add(patch);
    for (std::size_t k = first_neighbour_[patch]; k < first_neighbour_[patch + 1]; ++k) add(neighbours_[k]);
    normalise(stencil);
}

Rgb Interpolation::value(const Stencil& stencil, std::span<const Rgb> values,
                         std::span<const float> confidence) {
    Rgb sum(0);
    float weight = 0;
    for (const PatchWeight& entry : stencil.patches()) {
        const float w = entry.weight * confidence[entry.patch];
        sum += w * values[entry.patch];
        weight += w;
    }
    return weight > 0 ? sum / weight : Rgb(0);
}

}  // namespace afterglow
