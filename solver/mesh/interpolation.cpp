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
    const float sum = std::accumulate(
        stencil.weight.begin(), stencil.weight.begin() + static_cast<std::ptrdiff_t>(stencil.count), 0.0F);
    for (std::size_t k = 0; k < stencil.count; ++k) stencil.weight[k] /= sum;
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
        if (grid.first_cell[which] != std::size_t{no_index})
            stencil = on_grid(grid, grid.first_cell[which], position);
    } else if (const Index patch = mesh_->patch_of_triangle[body][which][triangle]; patch != no_index) {
        stencil = on_clusters(patch, position);
    }
    if (stencil.count == 0) {
        const Index patch = mesh_->patch_at(body, triangle, side, position);
        if (patch != no_index) stencil.add(patch, 1);
    }
    return stencil;
}

Stencil Interpolation::on_grid(const SurfaceGrid& grid, std::size_t first_cell, const Vec3& position) const {
    const Vec3 d = position - grid.origin;
    const float u = std::clamp(glm::dot(d, grid.per_metre_u), 0.0F, static_cast<float>(grid.cells_u)) - 0.5F;
    const float v = std::clamp(glm::dot(d, grid.per_metre_v), 0.0F, static_cast<float>(grid.cells_v)) - 0.5F;
    const int u0 = static_cast<int>(std::floor(u)), v0 = static_cast<int>(std::floor(v));
    const float fu = u - static_cast<float>(u0), fv = v - static_cast<float>(v0);
    Stencil stencil;
    for (int dv = 0; dv < 2; ++dv) {
        for (int du = 0; du < 2; ++du) {
            const int cu = u0 + du, cv = v0 + dv;
            if (cu < 0 || cv < 0 || cu >= grid.cells_u || cv >= grid.cells_v) continue;
            const Index patch =
                mesh_->patch_of_cell[first_cell +
                                     static_cast<std::size_t>(cv) * static_cast<std::size_t>(grid.cells_u) +
                                     static_cast<std::size_t>(cu)];
            if (patch != no_index) stencil.add(patch, (du == 1 ? fu : 1 - fu) * (dv == 1 ? fv : 1 - fv));
        }
    }
    normalise(stencil);
    return stencil;
}

Stencil Interpolation::on_clusters(Index patch, const Vec3& position) const {
    // The kernel reaches as far as the farthest neighbour's centre, where its weight falls to zero.
    float reach = 0;
    for (std::size_t k = first_neighbour_[patch]; k < first_neighbour_[patch + 1]; ++k)
        reach = std::max(reach, glm::length(mesh_->centre[neighbours_[k]] - mesh_->centre[patch]));
    Stencil stencil;
    if (reach <= 0) {
        stencil.add(patch, 1);
        return stencil;
    }
    const auto add = [&](Index p) {
        const Vec3 d = position - mesh_->centre[p];
        const float share = std::max(0.0F, 1 - glm::dot(d, d) / (reach * reach));
        stencil.add(p, mesh_->area_m2[p] * share * share);
    };
    add(patch);
    for (std::size_t k = first_neighbour_[patch]; k < first_neighbour_[patch + 1]; ++k) add(neighbours_[k]);
    normalise(stencil);
    return stencil;
}

Rgb Interpolation::value(const Stencil& stencil, std::span<const Rgb> values,
                         std::span<const float> confidence) {
    Rgb sum(0);
    float weight = 0;
    for (std::size_t k = 0; k < stencil.count; ++k) {
        const float w = stencil.weight[k] * confidence[stencil.patch[k]];
        sum += w * values[stencil.patch[k]];
        weight += w;
    }
    return weight > 0 ? sum / weight : Rgb(0);
}

}  // namespace afterglow
