#include "solver/mesh/kept_numbers.h"

#include <algorithm>
#include <tuple>

namespace afterglow {

namespace {

/// Where a patch lies: nearly always enough to tell it from all others.
auto place_of(const PatchMesh& mesh, Index p) {
    const Vec3 &c = mesh.centre[p], &n = mesh.normal[p];
    return std::make_tuple(c.x, c.y, c.z, n.x, n.y, n.z);
}

bool same_fragments(const PatchMesh& a, Index p, const PatchMesh& b, Index q) {
    const std::size_t first_a = a.first_fragment[p], first_b = b.first_fragment[q];
    const std::size_t count = a.first_fragment[p + 1] - first_a;
    if (count != b.first_fragment[q + 1] - first_b) return false;
    for (std::size_t k = 0; k < count; ++k) {
        const Fragment &x = a.fragments[first_a + k], &y = b.fragments[first_b + k];
        if (x.corner != y.corner || x.edge_a != y.edge_a || x.edge_b != y.edge_b || x.normal != y.normal ||
            x.cumulative_share != y.cumulative_share)
            return false;
    }
    return true;
}

/// Whether the same samples stand for the same points of both.
bool same_shape(const PatchMesh& a, Index p, const PatchMesh& b, Index q) {
    return place_of(a, p) == place_of(b, q) && a.area_m2[p] == b.area_m2[q] && a.origin[p] == b.origin[q] &&
           a.edge_u[p] == b.edge_u[q] && a.edge_v[p] == b.edge_v[q] && same_fragments(a, p, b, q);
}

/// The static patches, ordered by where they lie.
std::vector<Index> by_place(const PatchMesh& mesh) {
    std::vector<Index> order(mesh.static_size());
    for (Index p = 0; p < order.size(); ++p) order[p] = p;
    std::sort(order.begin(), order.end(), [&](Index p, Index q) {
        return std::make_tuple(place_of(mesh, p), p) < std::make_tuple(place_of(mesh, q), q);
    });
    return order;
}

/// By static patch of `mesh`: its like in `before`, or no_index.
std::vector<Index> likes(const PatchMesh& before, const PatchMesh& mesh) {
    const auto old = by_place(before), now = by_place(mesh);
    std::vector<Index> like(now.size(), no_index);
    const auto alone = [](const PatchMesh& in, const std::vector<Index>& order, std::size_t k) {
        const auto here = place_of(in, order[k]);
        return (k == 0 || place_of(in, order[k - 1]) != here) &&
               (k + 1 == order.size() || place_of(in, order[k + 1]) != here);
    };
    for (std::size_t i = 0, k = 0; k < now.size(); ++k) {
        while (i < old.size() && place_of(before, old[i]) < place_of(mesh, now[k])) ++i;
        if (i < old.size() && same_shape(before, old[i], mesh, now[k]) && alone(before, old, i) &&
            alone(mesh, now, k))
            like[now[k]] = old[i];
    }
    return like;
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<Index>& number) {
    const std::vector<T> old = values;
    for (std::size_t p = 0; p < number.size(); ++p) values[number[p]] = old[p];
}

void reorder_fragments(PatchMesh& mesh, const std::vector<Index>& number) {
    std::vector<Index> patch(number.size());
    for (Index p = 0; p < number.size(); ++p) patch[number[p]] = p;
    const auto first = std::move(mesh.first_fragment);
    const auto fragments = std::move(mesh.fragments);
    mesh.first_fragment.assign(1, 0);
    mesh.fragments.clear();
    for (const Index p : patch) {
        mesh.fragments.insert(mesh.fragments.end(), fragments.begin() + static_cast<std::ptrdiff_t>(first[p]),
                              fragments.begin() + static_cast<std::ptrdiff_t>(first[p + 1]));
        mesh.first_fragment.push_back(mesh.fragments.size());
    }
}

/// `number`: by patch, all of them.
void renumber(PatchMesh& mesh, const std::vector<Index>& number) {
    const auto rename = [&](Index& entry) {
        if (entry != no_index && !CellTree::is_divided(entry) && !CellTree::is_split(entry))
            entry = number[entry];
    };
    for (auto& sides : mesh.trees) {
        for (CellTree& tree : sides) {
            std::for_each(tree.cells.begin(), tree.cells.end(), rename);
            for (auto& quarter : tree.quarters) std::for_each(quarter.begin(), quarter.end(), rename);
            for (auto& split : tree.splits) std::for_each(split.part.begin(), split.part.end(), rename);
        }
    }
    for (auto& sides : mesh.patch_of_triangle)
        for (auto& triangles : sides) std::for_each(triangles.begin(), triangles.end(), rename);
    reorder(mesh.area_m2, number);
    reorder(mesh.centre, number);
    reorder(mesh.normal, number);
    reorder(mesh.surface, number);
    reorder(mesh.side, number);
    reorder(mesh.texture_mean, number);
    reorder(mesh.origin, number);
    reorder(mesh.edge_u, number);
    reorder(mesh.edge_v, number);
    reorder_fragments(mesh, number);
}

}  // namespace

std::vector<std::uint8_t> keep_numbers(const PatchMesh& before, PatchMesh& mesh) {
    const Index count = mesh.static_size();
    const auto like = likes(before, mesh);
    std::vector<std::uint8_t> kept(count, 0);
    std::vector<Index> number(mesh.size(), no_index);
    for (Index p = 0; p < count; ++p) {
        if (like[p] >= count) continue;  // no_index is past all
        number[p] = like[p];
        kept[like[p]] = 1;
    }
    Index next = 0;
    for (Index p = 0; p < count; ++p) {
        if (number[p] != no_index) continue;
        while (kept[next] != 0) ++next;
        number[p] = next++;
    }
    for (Index p = count; p < mesh.size(); ++p) number[p] = p;
    renumber(mesh, number);
    return kept;
}

}  // namespace afterglow
