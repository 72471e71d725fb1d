#include <algorithm>
#include <cmath>
#include <deque>

#include "solver/mesh/adjacency.h"
#include "solver/mesh/patch_shape.h"

namespace afterglow {

namespace {

constexpr float cluster_cosine = 0.8F;  // 37°: normals of one patch stay this near its first facet's

Box bounds_of(const Body& body, Index t) {
    Box box;
    for (const Index v : body.triangles[t].vertices) box.add(body.positions[v]);
    return box;
}

PatchShape make_shape(const World& world, const Body& body, const Surface& surface,
                      const std::vector<Index>& triangles) {
    PatchShape shape;
    const Index texture = world.materials[surface.material].texture;
    Rgb colour(0);
    Vec3 normal_sum(0);
    for (const Index t : triangles) {
        const auto& v = body.triangles[t].vertices;
        const Vec3 doubled = doubled_area_normal(body, t);
        const float area = 0.5F * glm::length(doubled);
        const Vec3 a = body.positions[v[0]], b = body.positions[v[1]], c = body.positions[v[2]];
        shape.area_m2 += area;
        shape.centre += area / 3.0F * (a + b + c);
        normal_sum += doubled;
        shape.fragments.push_back({a, b - a, c - a, glm::normalize(doubled), shape.area_m2});
        if (texture != no_index)
            colour += area * mean_texture(world.textures[texture],
                                          {body.texture_coordinates[v[0]], body.texture_coordinates[v[1]],
                                           body.texture_coordinates[v[2]]});
    }
    shape.centre /= shape.area_m2;
    shape.normal = glm::normalize(normal_sum);
    if (texture != no_index) shape.texture_mean = colour / shape.area_m2;
    for (auto& fragment : shape.fragments) fragment.cumulative_share /= shape.area_m2;
    shape.fragments.back().cumulative_share = 1;
    return shape;
}

}  // namespace

SurfaceShapes divide_curved(const World& world, const Surface& surface, float size_m) {
    const Body& body = world.bodies[surface.body];
    // Adjacency within this surface only: a body of the surface's triangles alone.
    Body part{body.name, body.positions, {}, {}, {}};
    for (const Index t : surface.triangles) part.triangles.push_back(body.triangles[t]);
    const Adjacency adjacency = find_adjacency(part);

    SurfaceShapes out;
    std::vector<char> taken(part.triangles.size(), 0);
    std::deque<Index> queue;
    for (Index seed = 0; seed < part.triangles.size(); ++seed) {
        if (taken[seed] != 0) continue;
        const Vec3 normal = glm::normalize(doubled_area_normal(part, seed));
        Box box;
        std::vector<Index> members;
        queue.assign(1, seed);
        while (!queue.empty()) {
            const Index t = queue.front();
            queue.pop_front();
            Box grown = box;
            grown.add(bounds_of(part, t));
            const bool fits = members.empty() || (glm::length(grown.extent()) <= 1.3F * size_m &&
                                                  glm::dot(glm::normalize(doubled_area_normal(part, t)),
                                                           normal) > cluster_cosine);
            if (taken[t] != 0 || !fits) continue;
            taken[t] = 1;
            box = grown;
            members.push_back(surface.triangles[t]);
            for (std::size_t k = adjacency.begin[t]; k < adjacency.begin[t + 1]; ++k)
                if (taken[adjacency.neighbour[k]] == 0) queue.push_back(adjacency.neighbour[k]);
        }
        out.shapes.push_back(make_shape(world, body, surface, members));
        out.triangles.push_back(std::move(members));
    }
    return out;
}

}  // namespace afterglow
