#include "solver/visibility/view_groups.h"

#include <algorithm>

namespace afterglow {

namespace {

/// Everywhere a patch's lines may begin.
Box origins_of(const PatchMesh& mesh, Index patch, float lift_m) {
    Box box;
    const auto add = [&](const Vec3& point, const Vec3& normal) { box.add(point + lift_m * normal); };
    const std::size_t first = mesh.first_fragment[patch], last = mesh.first_fragment[patch + 1];
    if (first == last) {
        const Vec3 &at = mesh.origin[patch], &u = mesh.edge_u[patch], &v = mesh.edge_v[patch];
        for (const Vec3& corner : {at, at + u, at + v, at + u + v}) add(corner, mesh.normal[patch]);
    }
    for (std::size_t k = first; k < last; ++k) {
        const Fragment& part = mesh.fragments[k];
        for (const Vec3& corner : {part.corner, part.corner + part.edge_a, part.corner + part.edge_b})
            add(corner, part.normal);
    }
    // Points are interpolated in single precision.
    return {box.low - Vec3(lift_m), box.high + Vec3(lift_m)};
}

std::size_t blocks_together(Grouping grouping) {
    if (grouping == Grouping::four_blocks) return 4;
    return grouping == Grouping::surface ? std::numeric_limits<std::size_t>::max() : 1;
}

}  // namespace

std::vector<ViewGroup> make_view_groups(const PatchMesh& mesh, const SightLines& sight, Grouping grouping) {
    std::vector<ViewGroup> groups;
    const std::size_t most = blocks_together(grouping);
    for (std::size_t b = 0; b < sight.static_blocks(); ++b) {
        const PatchBlock& block = sight.blocks()[b];
        const auto same_side = [&](const ViewGroup& group) {
            const Index first = sight.blocks()[group.first_block].first;
            return mesh.surface[first] == mesh.surface[block.first] &&
                   mesh.side[first] == mesh.side[block.first];
        };
        if (groups.empty() || b - groups.back().first_block >= most || !same_side(groups.back()))
            groups.push_back({b, b, 0xFFFF, {}, {}});
        for (Index lane = 0; lane < block.count; ++lane) {
            if (grouping == Grouping::patch) {
                if (lane > 0) groups.push_back({b, b, 0, {}, {}});
                groups.back().lanes = 1U << lane;
            }
            groups.back().last_block = b + 1;
            groups.back().origins.add(origins_of(mesh, block.first + lane, sight.lift_m()));
        }
    }
    for (ViewGroup& group : groups)
        group.viewpoint = {Vec3d(group.origins.centre()), 0.5 * glm::length(Vec3d(group.origins.extent())),
                           0.5 * Vec3d(group.origins.extent())};
    return groups;
}

}  // namespace afterglow
