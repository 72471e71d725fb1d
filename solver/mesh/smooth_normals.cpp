#include "solver/mesh/smooth_normals.h"

#include <map>
#include <utility>

#include "solver/mesh/adjacency.h"

namespace afterglow {

SmoothNormals::SmoothNormals(const World& world, const Surfaces& surfaces)
    : corners_(world.bodies.size()), world_(&world) {
    std::vector<std::vector<std::array<Index, 3>>> welded(world.bodies.size());
    for (const Surface& surface : surfaces.list) {
        if (surface.kind != Surface::Kind::curved) continue;
        const Body& body = world.bodies[surface.body];
        if (welded[surface.body].empty()) {
            welded[surface.body] = find_adjacency(body).welded;
            // A zero normal stands for the triangle's own.
            corners_[surface.body].assign(body.triangles.size(), {Vec3(0), Vec3(0), Vec3(0)});
        }
        std::map<Index, Vec3> around;
        for (const Index t : surface.triangles)
            for (const Index v : welded[surface.body][t]) around[v] += doubled_area_normal(body, t);
        for (const Index t : surface.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3& sum = around[welded[surface.body][t][k]];
                const float length = glm::length(sum);
                if (length > 0) corners_[surface.body][t][k] = sum / length;
            }
        }
    }
}

Vec3 SmoothNormals::at(Index body, Index triangle, float u, float v) const {
    const Vec3 facet = glm::normalize(doubled_area_normal(world_->bodies[body], triangle));
    if (corners_[body].empty()) return facet;
    const auto& corner = corners_[body][triangle];
    const Vec3 mean = (1 - u - v) * corner[0] + u * corner[1] + v * corner[2];
    // Where facets fold over, the mean may point the other way or nowhere.
    return glm::dot(mean, facet) > 0 ? glm::normalize(mean) : facet;
}

}  // namespace afterglow
