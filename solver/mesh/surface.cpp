#include "solver/mesh/surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/mesh/adjacency.h"

namespace afterglow {

namespace {

constexpr float flat_cosine = 0.99995F;          // 0.6°: facets of a flat piece
constexpr float flat_distance_per_size = 1e-4F;  // distance from the plane, relative to the body's size

/// Facets of one body: maximal connected sets of triangles in the plane of their first triangle.
struct Facets {
    std::vector<Index> of_triangle;
    std::vector<std::vector<Index>> triangles;
    std::vector<Vec3> normal;  // unit
};

Vec3 unit_normal(const Body& body, Index t) {
    return glm::normalize(doubled_area_normal(body, t));
}

Box bounds_of(const Body& body) {
    Box box;
    for (const auto& p : body.positions) box.add(p);
    return box;
}

Facets find_facets(const Body& body, const Adjacency& adjacency) {
    Facets out;
    out.of_triangle.assign(body.triangles.size(), no_index);
    const float tolerance = flat_distance_per_size * glm::length(bounds_of(body).extent());
    std::vector<Index> stack;
    for (Index seed = 0; seed < body.triangles.size(); ++seed) {
        if (out.of_triangle[seed] != no_index) continue;
        const auto facet = static_cast<Index>(out.triangles.size());
        const Vec3 normal = unit_normal(body, seed);
        const Vec3 origin = body.positions[body.triangles[seed].vertices[0]];
        const auto in_plane = [&](Index t) {
            if (glm::dot(unit_normal(body, t), normal) < flat_cosine) return false;
            return std::all_of(
                body.triangles[t].vertices.begin(), body.triangles[t].vertices.end(),
                [&](Index v) { return std::abs(glm::dot(body.positions[v] - origin, normal)) <= tolerance; });
        };
        auto& members = out.triangles.emplace_back();
        out.normal.push_back(normal);
        out.of_triangle[seed] = facet;
        stack.assign(1, seed);
        while (!stack.empty()) {
            const Index t = stack.back();
            stack.pop_back();
            members.push_back(t);
            for (std::size_t k = adjacency.begin[t]; k < adjacency.begin[t + 1]; ++k) {
                const Index next = adjacency.neighbour[k];
                if (out.of_triangle[next] != no_index ||
                    body.triangles[next].material != body.triangles[seed].material || !in_plane(next))
                    continue;
                out.of_triangle[next] = facet;
                stack.push_back(next);
            }
        }
        std::sort(members.begin(), members.end());
    }
    return out;
}

bool is_small(const Body& body, const std::vector<Index>& triangles, float size) {
    Box box;
    for (const Index t : triangles)
        for (const Index v : body.triangles[t].vertices) box.add(body.positions[v]);
    return glm::length(box.extent()) <= size;
}

/// Union–find over facets; the smaller number is the root, so the result does not depend on the order of
/// unions.
class Groups {
  public:
    explicit Groups(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }
    Index root(Index i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(Index a, Index b) {
        const auto [low, high] = std::minmax({root(a), root(b)});  // by value: roots are temporaries
        parent_[high] = low;
    }

  private:
    std::vector<Index> parent_;
};

/// Joins small facets of one material that meet at a shallow angle.
Groups join_small_facets(const Body& body, const Adjacency& adjacency, const Facets& facets,
                         const SurfaceConfig& config) {
    std::vector<char> small(facets.triangles.size());
    for (std::size_t f = 0; f < small.size(); ++f)
        small[f] = static_cast<char>(is_small(body, facets.triangles[f], config.facet_size_m));
    Groups groups(facets.triangles.size());
    const float cosine = std::cos(config.smooth_angle);
    for (Index t = 0; t < body.triangles.size(); ++t) {
        const Index a = facets.of_triangle[t];
        for (std::size_t k = adjacency.begin[t]; k < adjacency.begin[t + 1]; ++k) {
            const Index other = adjacency.neighbour[k];
            const Index b = facets.of_triangle[other];
            if (a < b && small[a] != 0 && small[b] != 0 &&
                body.triangles[t].material == body.triangles[other].material &&
                glm::dot(facets.normal[a], facets.normal[b]) > cosine)
                groups.join(a, b);
        }
    }
    return groups;
}

Surface make_surface(const Body& body, Index body_index, std::vector<Index> triangles, Surface::Kind kind) {
    Surface surface{kind, body_index, body.triangles[triangles.front()].material, Vec3(0), 0, {}};
    Vec3 sum(0);
    for (const Index t : triangles) {
        const Vec3 n = doubled_area_normal(body, t);
        sum += n;
        surface.area_m2 += 0.5F * glm::length(n);
    }
    // A closed curved surface has no mean normal; any direction serves then.
    const float length = glm::length(sum);
    surface.normal = length > 0 ? sum / length : Vec3(0, 0, 1);
    surface.triangles = std::move(triangles);
    return surface;
}

}  // namespace

Vec3 doubled_area_normal(const Body& body, Index triangle) {
    const auto& v = body.triangles[triangle].vertices;
    const Vec3& a = body.positions[v[0]];
    return glm::cross(body.positions[v[1]] - a, body.positions[v[2]] - a);
}

Surfaces find_surfaces(const World& world, const SurfaceConfig& config) {
    Surfaces out;
    out.of_triangle.resize(world.bodies.size());
    for (Index b = 0; b < world.bodies.size(); ++b) {
        const Body& body = world.bodies[b];
        const Adjacency adjacency = find_adjacency(body);
        const Facets facets = find_facets(body, adjacency);
        Groups groups = join_small_facets(body, adjacency, facets, config);

        std::vector<std::vector<Index>> facets_of_group(facets.triangles.size());
        for (Index f = 0; f < facets.triangles.size(); ++f) facets_of_group[groups.root(f)].push_back(f);
        out.of_triangle[b].resize(body.triangles.size());
        for (const auto& group : facets_of_group) {
            if (group.empty()) continue;
            std::vector<Index> triangles;
            for (const Index f : group)
                triangles.insert(triangles.end(), facets.triangles[f].begin(), facets.triangles[f].end());
            std::sort(triangles.begin(), triangles.end());
            for (const Index t : triangles) out.of_triangle[b][t] = static_cast<Index>(out.list.size());
            const auto kind = group.size() == 1 ? Surface::Kind::flat : Surface::Kind::curved;
            out.list.push_back(make_surface(body, b, std::move(triangles), kind));
        }
    }
    return out;
}

}  // namespace afterglow
