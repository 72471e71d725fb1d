#include "solver/mesh/plane_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "solver/base/error.h"

namespace afterglow {

namespace {

constexpr double max_cells = 4e6;

/// Along the longest border edge of the surface, so that rectangles fall into whole cells.
Vec3 main_direction(const Body& body, const Surface& surface) {
    std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> uses;
    const auto as_key = [](const Vec3& p) { return std::array{p.x, p.y, p.z}; };
    for (const Index t : surface.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            auto a = as_key(body.positions[body.triangles[t].vertices[k]]);
            auto b = as_key(body.positions[body.triangles[t].vertices[(k + 1) % 3]]);
            if (b < a) std::swap(a, b);
            ++uses[{a, b}];
        }
    }
    Vec3 longest(0);
    for (const auto& [edge, count] : uses) {
        const Vec3 along(edge.second[0] - edge.first[0], edge.second[1] - edge.first[1],
                         edge.second[2] - edge.first[2]);
        // A hair longer does not count: equal edges must not be told apart by rounding.
        if (count == 1 && glm::length(along) > 1.0001F * glm::length(longest)) longest = along;
    }
    // A surface folded onto itself has no border; any direction in its plane serves.
    if (longest == Vec3(0)) longest = Frame(surface.normal).x;
    return glm::normalize(longest - glm::dot(longest, surface.normal) * surface.normal);
}

}  // namespace

PlaneGrid lay_grid(const Body& body, const Surface& surface, float size_m) {
    const Vec3 u = main_direction(body, surface);
    const Vec3 v = glm::cross(surface.normal, u);
    const Vec3 base = body.positions[body.triangles[surface.triangles.front()].vertices[0]];
    Vec2 low(0), high(0);
    for (const Index t : surface.triangles) {
        for (const Index vertex : body.triangles[t].vertices) {
            const Vec3 d = body.positions[vertex] - base;
            const Vec2 at(glm::dot(d, u), glm::dot(d, v));
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
    }
    const Vec2 extent = glm::max(high - low, Vec2(1e-12F));
    const double wanted_u = std::max(1.0, std::ceil(static_cast<double>(extent.x) / size_m - 1e-3));
    const double wanted_v = std::max(1.0, std::ceil(static_cast<double>(extent.y) / size_m - 1e-3));
    if (wanted_u * wanted_v > max_cells)
        throw Error(ErrorKind::too_large, "patch_size",
                    "a surface of " + body.name +
                        " would be divided into more than 4 million cells; use larger patches");
    const Vec2 cell(extent.x / static_cast<float>(wanted_u), extent.y / static_cast<float>(wanted_v));
    PlaneGrid out;
    out.grid.origin = base + low.x * u + low.y * v;
    out.grid.per_metre_u = u / cell.x;
    out.grid.per_metre_v = v / cell.y;
    out.grid.cells_u = static_cast<int>(wanted_u);
    out.grid.cells_v = static_cast<int>(wanted_v);
    out.edge_u = u * cell.x;
    out.edge_v = v * cell.y;
    out.cell_m = cell;
    return out;
}

}  // namespace afterglow
