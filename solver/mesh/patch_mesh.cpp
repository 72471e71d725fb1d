#include "solver/mesh/patch_mesh.h"

#include <algorithm>
#include <cmath>

#include "solver/base/error.h"
#include "solver/mesh/patch_shape.h"

namespace afterglow {

namespace {

constexpr std::size_t max_patches = 4'000'000;

void append(PatchMesh& mesh, const PatchShape& shape, Index surface, Side side) {
    const float sign = side == Side::front ? 1.0F : -1.0F;
    mesh.area_m2.push_back(shape.area_m2);
    mesh.centre.push_back(shape.centre);
    mesh.normal.push_back(sign * shape.normal);
    mesh.body.push_back(mesh.surfaces.list[surface].body);
    mesh.surface.push_back(surface);
    mesh.side.push_back(side);
    mesh.texture_mean.push_back(shape.texture_mean);
    mesh.origin.push_back(shape.origin);
    mesh.edge_u.push_back(shape.edge_u);
    mesh.edge_v.push_back(shape.edge_v);
    for (Fragment fragment : shape.fragments) {
        fragment.normal *= sign;
        mesh.fragments.push_back(fragment);
    }
    mesh.first_fragment.push_back(mesh.fragments.size());
}

/// Adds one side of a divided surface and the way to find its patches.
void add_side(PatchMesh& mesh, const SurfaceShapes& divided, Index surface, Side side) {
    const auto s = static_cast<std::size_t>(side);
    const bool flat = divided.grid.cells_u > 0;
    const auto first_cell = mesh.patch_of_cell.size();
    if (flat) {
        mesh.grids[surface].first_cell[s] = first_cell;
        mesh.patch_of_cell.resize(first_cell + static_cast<std::size_t>(divided.grid.cells_u) *
                                                   static_cast<std::size_t>(divided.grid.cells_v),
                                  no_index);
    }
    for (const PatchShape& shape : divided.shapes) {
        const Index patch = mesh.size();
        append(mesh, shape, surface, side);
        if (flat) mesh.patch_of_cell[first_cell + shape.cell] = patch;
        for (const Index t : shape.triangles)
            mesh.patch_of_triangle[mesh.surfaces.list[surface].body][s][t] = patch;
    }
    if (mesh.size() > max_patches)
        throw Error(ErrorKind::too_large, "patch_size",
                    "the scene would have more than 4 million patches; use larger ones");
}

}  // namespace

PatchMesh make_patches(const World& world, Surfaces surfaces, const SideMask& wanted,
                       const MeshConfig& config) {
    PatchMesh mesh;
    mesh.surfaces = std::move(surfaces);
    mesh.first_fragment.push_back(0);
    mesh.first_patch_of_body.push_back(0);
    mesh.grids.resize(mesh.surfaces.list.size());
    mesh.patch_of_triangle.resize(world.bodies.size());
    for (Index b = 0; b < world.bodies.size(); ++b)
        for (auto& side : mesh.patch_of_triangle[b]) side.assign(world.bodies[b].triangles.size(), no_index);

    // Surfaces stand body by body, so the patches do too.
    for (Index s = 0; s < mesh.surfaces.list.size(); ++s) {
        const Surface& surface = mesh.surfaces.list[s];
        while (mesh.first_patch_of_body.size() <= surface.body)
            mesh.first_patch_of_body.push_back(mesh.size());
        mesh.grids[s].first_cell.fill(std::size_t{no_index});
        if (!wanted[s][0] && !wanted[s][1]) continue;
        const SurfaceShapes divided = surface.kind == Surface::Kind::flat
                                          ? divide_flat(world, surface, config.patch_size_m)
                                          : divide_curved(world, surface, config.patch_size_m);
        const auto first_cell = mesh.grids[s].first_cell;
        mesh.grids[s] = divided.grid;
        mesh.grids[s].first_cell = first_cell;
        if (wanted[s][0]) add_side(mesh, divided, s, Side::front);
        if (wanted[s][1]) add_side(mesh, divided, s, Side::back);
    }
    while (mesh.first_patch_of_body.size() <= world.bodies.size())
        mesh.first_patch_of_body.push_back(mesh.size());
    return mesh;
}

Index PatchMesh::patch_at(Index body_index, Index triangle, Side on, const Vec3& position) const {
    const Index s = surfaces.of_triangle[body_index][triangle];
    const SurfaceGrid& grid = grids[s];
    const auto which = static_cast<std::size_t>(on);
    if (grid.cells_u == 0) return patch_of_triangle[body_index][which][triangle];
    const std::size_t first = grid.first_cell[which];
    if (first == std::size_t{no_index}) return no_index;

    const Vec3 d = position - grid.origin;
    const int u = std::clamp(static_cast<int>(glm::dot(d, grid.per_metre_u)), 0, grid.cells_u - 1);
    const int v = std::clamp(static_cast<int>(glm::dot(d, grid.per_metre_v)), 0, grid.cells_v - 1);
    const auto at = [&](int cu, int cv) {
        return patch_of_cell[first + static_cast<std::size_t>(cv) * static_cast<std::size_t>(grid.cells_u) +
                             static_cast<std::size_t>(cu)];
    };
    const Index patch = at(u, v);
    if (patch != no_index) return patch;
    // A point on a border can fall just outside the cells that have area: a neighbour answers for it.
    for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du)
            if (u + du >= 0 && u + du < grid.cells_u && v + dv >= 0 && v + dv < grid.cells_v &&
                at(u + du, v + dv) != no_index)
                return at(u + du, v + dv);
    return no_index;
}

PatchPoint PatchMesh::point_on(Index patch, float s, float t) const {
    const std::size_t first = first_fragment[patch], last = first_fragment[patch + 1];
    if (first == last) return {origin[patch] + s * edge_u[patch] + t * edge_v[patch], normal[patch]};
    std::size_t i = first;
    while (i + 1 < last && s >= fragments[i].cumulative_share) ++i;
    // What is left of s within the chosen fragment is uniform again.
    const float before = i == first ? 0.0F : fragments[i - 1].cumulative_share;
    const float share = fragments[i].cumulative_share - before;
    float a = share > 0 ? std::clamp((s - before) / share, 0.0F, 1.0F) : 0.0F;
    float b = t;
    // Folds the unit square onto the triangle and keeps neighbours together (Heitz 2019).
    if (b > a) {
        a *= 0.5F;
        b -= a;
    } else {
        b *= 0.5F;
        a -= b;
    }
    const Fragment& f = fragments[i];
    return {f.corner + a * f.edge_a + b * f.edge_b, f.normal};
}

}  // namespace afterglow
