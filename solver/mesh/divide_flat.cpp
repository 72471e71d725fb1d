#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "solver/base/error.h"
#include "solver/mesh/patch_shape.h"

namespace afterglow {

namespace {

constexpr double max_cells = 4e6;
constexpr float whole_cell_share = 0.9999F;  // covered by this much, a cell counts as a whole rectangle
constexpr float sliver_share = 1e-5F;        // below it, the neighbouring cell answers for the sliver

/// A corner of a clipped triangle: where in the grid, and how far from the triangle's own corners.
struct Corner {
    Vec2 cell;         // cell coordinates
    Vec3 barycentric;  // of the triangle
};
/// A triangle clipped by four lines has at most seven corners.
struct Polygon {
    std::array<Corner, 8> corners;
    int count = 0;

    void add(const Corner& c) { corners[static_cast<std::size_t>(count++)] = c; }
    [[nodiscard]] const Corner& operator[](int i) const { return corners[static_cast<std::size_t>(i)]; }
};

/// Keeps the part where sign · (coordinate − bound) ≥ 0 (Sutherland and Hodgman 1974).
Polygon clip(const Polygon& in, int axis, float bound, float sign) {
    Polygon out;
    for (int i = 0; i < in.count; ++i) {
        const Corner& a = in[i];
        const Corner& b = in[(i + 1) % in.count];
        const float da = sign * (a.cell[axis] - bound);
        const float db = sign * (b.cell[axis] - bound);
        if (da >= 0) out.add(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            const float t = da / (da - db);
            out.add({glm::mix(a.cell, b.cell, t), glm::mix(a.barycentric, b.barycentric, t)});
        }
    }
    return out;
}

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

struct PlaneGrid {
    SurfaceGrid grid;
    Vec3 edge_u, edge_v;  // of one cell
    float cell_area;
};

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
    out.cell_area = cell.x * cell.y;
    return out;
}

/// What lies in one cell.
struct CellContent {
    float area = 0;  // in cells
    Vec2 moment{0};  // area × centroid, cell coordinates
    Rgb colour{0};   // area × texture colour
    std::vector<std::array<Vec2, 3>> pieces;
};

class FlatDivision {
  public:
    FlatDivision(const World& world, const Surface& surface, float size_m)
        : world_(world),
          body_(world.bodies[surface.body]),
          surface_(surface),
          plane_(lay_grid(body_, surface, size_m)),
          cells_(static_cast<std::size_t>(plane_.grid.cells_u) *
                 static_cast<std::size_t>(plane_.grid.cells_v)) {}

    SurfaceShapes run() {
        for (const Index t : surface_.triangles) add_triangle(t);
        SurfaceShapes out{plane_.grid, {}};
        constexpr int tile = 4;
        for (int v0 = 0; v0 < plane_.grid.cells_v; v0 += tile)
            for (int u0 = 0; u0 < plane_.grid.cells_u; u0 += tile)
                for (int v = v0; v < std::min(v0 + tile, plane_.grid.cells_v); ++v)
                    for (int u = u0; u < std::min(u0 + tile, plane_.grid.cells_u); ++u)
                        add_shape(u, v, out.shapes);
        return out;
    }

  private:
    [[nodiscard]] Vec2 to_cell(const Vec3& p) const {
        const Vec3 d = p - plane_.grid.origin;
        return {glm::dot(d, plane_.grid.per_metre_u), glm::dot(d, plane_.grid.per_metre_v)};
    }
    [[nodiscard]] Vec3 to_body(const Vec2& cell) const {
        return plane_.grid.origin + cell.x * plane_.edge_u + cell.y * plane_.edge_v;
    }

    void add_triangle(Index t) {
        Polygon whole;
        Vec2 low(1e30F), high(-1e30F);
        for (std::size_t k = 0; k < 3; ++k) {
            Corner corner{to_cell(body_.positions[body_.triangles[t].vertices[k]]), Vec3(0)};
            corner.barycentric[static_cast<int>(k)] = 1;
            low = glm::min(low, corner.cell);
            high = glm::max(high, corner.cell);
            whole.add(corner);
        }
        const auto first = [](float x) { return std::max(0, static_cast<int>(std::floor(x))); };
        const auto last = [](float x, int cells) {
            return std::min(cells - 1, static_cast<int>(std::floor(x)));
        };
        for (int v = first(low.y); v <= last(high.y, plane_.grid.cells_v); ++v) {
            const Polygon row =
                clip(clip(whole, 1, static_cast<float>(v), 1), 1, static_cast<float>(v + 1), -1);
            if (row.count < 3) continue;
            for (int u = first(low.x); u <= last(high.x, plane_.grid.cells_u); ++u) {
                const Polygon piece =
                    clip(clip(row, 0, static_cast<float>(u), 1), 0, static_cast<float>(u + 1), -1);
                if (piece.count >= 3) add_piece(cells_[cell_index(u, v)], piece, t);
            }
        }
    }

    void add_piece(CellContent& content, const Polygon& piece, Index t) {
        const Index texture = world_.materials[surface_.material].texture;
        for (int i = 1; i + 1 < piece.count; ++i) {
            const Corner &a = piece[0], &b = piece[i], &c = piece[i + 1];
            const Vec2 ab = b.cell - a.cell, ac = c.cell - a.cell;
            const float area = 0.5F * std::abs(ab.x * ac.y - ab.y * ac.x);
            if (area <= 0) continue;
            content.area += area;
            content.moment += area / 3.0F * (a.cell + b.cell + c.cell);
            content.pieces.push_back({a.cell, b.cell, c.cell});
            if (texture != no_index)
                content.colour +=
                    area * mean_texture(world_.textures[texture], {uv_at(t, a), uv_at(t, b), uv_at(t, c)});
        }
    }

    [[nodiscard]] Vec2 uv_at(Index t, const Corner& corner) const {
        Vec2 uv(0);
        for (std::size_t k = 0; k < 3; ++k)
            uv += corner.barycentric[static_cast<int>(k)] *
                  body_.texture_coordinates[body_.triangles[t].vertices[k]];
        return uv;
    }

    [[nodiscard]] std::size_t cell_index(int u, int v) const {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(plane_.grid.cells_u) +
               static_cast<std::size_t>(u);
    }

    void add_shape(int u, int v, std::vector<PatchShape>& shapes) const {
        const CellContent& content = cells_[cell_index(u, v)];
        if (content.area < sliver_share) return;
        PatchShape shape;
        shape.cell = cell_index(u, v);
        shape.normal = surface_.normal;
        shape.area_m2 = std::min(content.area, 1.0F) * plane_.cell_area;
        shape.centre = to_body(content.moment / content.area);
        if (world_.materials[surface_.material].texture != no_index)
            shape.texture_mean = content.colour / content.area;
        shape.origin = to_body(Vec2(u, v));
        shape.edge_u = plane_.edge_u;
        shape.edge_v = plane_.edge_v;
        if (content.area < whole_cell_share) add_fragments(content, shape);
        shapes.push_back(std::move(shape));
    }

    void add_fragments(const CellContent& content, PatchShape& shape) const {
        float sum = 0;
        for (const auto& [a, b, c] : content.pieces) {
            const Vec2 ab = b - a, ac = c - a;
            sum += 0.5F * std::abs(ab.x * ac.y - ab.y * ac.x);
            const Vec3 corner = to_body(a);
            shape.fragments.push_back(
                {corner, to_body(b) - corner, to_body(c) - corner, surface_.normal, sum / content.area});
        }
        shape.fragments.back().cumulative_share = 1;
    }

    const World& world_;
    const Body& body_;
    const Surface& surface_;
    PlaneGrid plane_;
    std::vector<CellContent> cells_;
};

}  // namespace

SurfaceShapes divide_flat(const World& world, const Surface& surface, float size_m) {
    return FlatDivision(world, surface, size_m).run();
}

Rgb mean_texture(const Texture& texture, const std::array<Vec2, 3>& corners) {
    // Midpoints of the 16 similar triangles that a division into quarters, twice, gives.
    constexpr int side = 4;
    Rgb sum(0);
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < 2 * (side - i) - 1; ++j) {
            const float a = (static_cast<float>(i) + (j % 2 == 0 ? 1.0F : 2.0F) / 3.0F) / side;
            const float b = (static_cast<float>(j / 2) + (j % 2 == 0 ? 1.0F : 2.0F) / 3.0F) / side;
            sum += texture.at((1 - a - b) * corners[0] + a * corners[1] + b * corners[2]);
        }
    }
    return sum / static_cast<float>(side * side);
}

}  // namespace afterglow
