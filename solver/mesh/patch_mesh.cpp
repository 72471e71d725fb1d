#include "solver/mesh/patch_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
void add_side(PatchMesh& mesh, SurfaceShapes divided, Index surface, Side side) {
    const auto s = static_cast<std::size_t>(side);
    const Index first = mesh.size();
    const auto number = [&](Index& entry) {
        if (entry != no_index && !CellTree::is_divided(entry) && !CellTree::is_split(entry)) entry += first;
    };
    for (Index& entry : divided.tree.cells) number(entry);
    for (auto& quarter : divided.tree.quarters) std::for_each(quarter.begin(), quarter.end(), number);
    for (auto& split : divided.tree.splits) std::for_each(split.part.begin(), split.part.end(), number);
    for (std::size_t k = 0; k < divided.triangles.size(); ++k)
        for (const Index t : divided.triangles[k])
            mesh.patch_of_triangle[mesh.surfaces.list[surface].body][s][t] = first + static_cast<Index>(k);
    for (const PatchShape& shape : divided.shapes) append(mesh, shape, surface, side);
    mesh.grids[surface] = divided.grid;
    mesh.trees[surface][s] = std::move(divided.tree);
    if (mesh.size() > max_patches)
        throw Error(ErrorKind::too_large, "patch_size",
                    "the scene would have more than 4 million patches; use larger ones");
}

/// The point that (s, t) stands for on a rectangle, or on its fragments where it has some.
PatchPoint point_within(const PatchPoint& origin, const Vec3& edge_u, const Vec3& edge_v,
                        std::span<const Fragment> fragments, float s, float t) {
    if (fragments.empty()) return {origin.position + s * edge_u + t * edge_v, origin.normal};
    std::size_t i = 0;
    while (i + 1 < fragments.size() && s >= fragments[i].cumulative_share) ++i;
    // What is left of s within the chosen fragment is uniform again.
    const float before = i == 0 ? 0.0F : fragments[i - 1].cumulative_share;
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

/// All wanted sides, [surface][side].
std::vector<std::array<SurfaceShapes, 2>> divide_all(const World& world, const Surfaces& surfaces,
                                                     const SideMask& wanted, const Cuts& cuts,
                                                     const MeshConfig& config, const Context& context) {
    std::vector<std::array<SurfaceShapes, 2>> divided(surfaces.list.size());
    context.for_chunks(2 * divided.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t s = i / 2, side = i % 2;
            if (!wanted[s][side]) continue;
            const Surface& surface = surfaces.list[s];
            const SurfaceSide on{static_cast<Side>(side), cuts.of_surface[s], cuts.lift_m};
            divided[s][side] = surface.kind == Surface::Kind::flat
                                   ? divide_flat(world, surface, on, config)
                                   : divide_curved(world, surface, config.patch_size_m);
        }
    });
    return divided;
}

}  // namespace

PatchMesh make_patches(const World& world, Surfaces surfaces, const SideMask& wanted,
                       const MeshConfig& config, const Context& context) {
    const Cuts cuts = find_cuts(world, surfaces, context);
    auto divided = divide_all(world, surfaces, wanted, cuts, config, context);
    PatchMesh mesh;
    mesh.lift_m = cuts.lift_m;
    mesh.surfaces = std::move(surfaces);
    mesh.first_fragment.push_back(0);
    mesh.first_patch_of_body.push_back(0);
    mesh.grids.resize(mesh.surfaces.list.size());
    mesh.trees.resize(mesh.surfaces.list.size());
    mesh.patch_of_triangle.resize(world.bodies.size());
    for (Index b = 0; b < world.bodies.size(); ++b)
        for (auto& side : mesh.patch_of_triangle[b]) side.assign(world.bodies[b].triangles.size(), no_index);

    // Surfaces stand body by body, so the patches do too.
    for (Index s = 0; s < mesh.surfaces.list.size(); ++s) {
        while (mesh.first_patch_of_body.size() <= mesh.surfaces.list[s].body)
            mesh.first_patch_of_body.push_back(mesh.size());
        for (const Side side : {Side::front, Side::back}) {
            const auto which = static_cast<std::size_t>(side);
            if (wanted[s][which]) add_side(mesh, std::move(divided[s][which]), s, side);
        }
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
    const CellTree& tree = trees[s][which];
    if (tree.empty()) return no_index;

    const Vec2 at = grid.cell_at(position);
    const CellTree::Leaf leaf = tree.leaf_at(at);
    if (leaf.item != no_index) return leaf.item;
    // A point on a border can fall just outside the cells that have area: a neighbour answers for it.
    for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
            const Vec2 beside = at + leaf.size * Vec2(du, dv);
            const Index neighbour = tree.leaf_at(beside).item;
            if (neighbour != no_index && !tree.is_divided_between(at, beside)) return neighbour;
        }
    }
    return no_index;
}

Vec3 PatchMesh::just_before(Index on_surface, const Vec3& position, const Vec3& direction) const {
    // Back to where the ray was twice a lift above the surface, but not far along it.
    constexpr float least_cosine = 0.1F;
    const float cosine = std::abs(glm::dot(direction, surfaces.list[on_surface].normal));
    return position - 2 * lift_m / std::max(cosine, least_cosine) * direction;
}

bool PatchMesh::slipped(Index on_surface, Side on, const Vec3& position, const Vec3& direction) const {
    const CellTree& tree = trees[on_surface][static_cast<std::size_t>(on)];
    if (tree.dividers.empty()) return false;
    const SurfaceGrid& grid = grids[on_surface];
    return tree.is_divided_between(grid.cell_at(position),
                                   grid.cell_at(just_before(on_surface, position, direction)));
}

PatchPoint PatchMesh::point_on_part(Index patch, float s, float t) const {
    const std::size_t first = first_fragment[patch], count = first_fragment[patch + 1] - first;
    return point_within({origin[patch], normal[patch]}, edge_u[patch], edge_v[patch],
                        {fragments.data() + first, count}, s, t);
}

PatchPoint PatchShape::point_on(float s, float t) const {
    return point_within({origin, normal}, edge_u, edge_v, fragments, s, t);
}

}  // namespace afterglow
