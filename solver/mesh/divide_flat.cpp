#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "solver/base/error.h"
#include "solver/mesh/clip.h"
#include "solver/mesh/patch_shape.h"

namespace afterglow {

namespace {

constexpr double max_cells = 4e6;
constexpr float whole_cell_share = 0.9999F;  // covered by this much, a cell counts as a whole rectangle
constexpr std::array<std::array<int, 2>, 8> neighbours{
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
constexpr float sliver_share = 1e-5F;  // below it, the neighbouring cell answers for the sliver

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

/// A cell or a part of one on its way to a patch.
struct Node {
    Vec2 low{0};
    float size = 1;
    std::vector<ClipPolygon> pieces;  // of the surface's triangles
    Index first_child = no_index;     // of four, once divided

    [[nodiscard]] bool is_leaf() const { return first_child == no_index; }
};

/// Area in cells and its first moment.
struct Extent {
    float area = 0;
    Vec2 moment{0};
};

/// Calls `visit(a, b, c, area)` for the triangles that a polygon falls into.
template <class Visit>
void for_triangles(const ClipPolygon& polygon, const Visit& visit) {
    for (int i = 1; i + 1 < polygon.count; ++i) {
        const ClipCorner &a = polygon[0], &b = polygon[i], &c = polygon[i + 1];
        const Vec2 ab = b.cell - a.cell, ac = c.cell - a.cell;
        const float area = 0.5F * std::abs(ab.x * ac.y - ab.y * ac.x);
        if (area > 0) visit(a, b, c, area);
    }
}

class FlatDivision {
  public:
    FlatDivision(const World& world, const Surface& surface, Side side, const MeshConfig& config)
        : world_(world),
          body_(world.bodies[surface.body]),
          surface_(surface),
          side_(side),
          config_(config),
          plane_(lay_grid(body_, surface, config.patch_size_m)) {
        for (int v = 0; v < plane_.grid.cells_v; ++v)
            for (int u = 0; u < plane_.grid.cells_u; ++u) nodes_.push_back({Vec2(u, v), 1, {}, no_index});
    }

    SurfaceShapes run() {
        for (const Index t : surface_.triangles) add_triangle(t);
        if (config_.is_too_coarse) {
            for (Index root = 0, roots = static_cast<Index>(nodes_.size()); root < roots; ++root)
                refine(root);
            while (balance()) {
            }
        }
        return emit();
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
        ClipPolygon whole;
        whole.triangle = t;
        Vec2 low(1e30F), high(-1e30F);
        for (std::size_t k = 0; k < 3; ++k) {
            ClipCorner corner{to_cell(body_.positions[body_.triangles[t].vertices[k]]), Vec3(0)};
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
            const ClipPolygon row = clip(clip(whole, 1, static_cast<float>(v), Keep::above), 1,
                                         static_cast<float>(v + 1), Keep::below);
            if (row.count < 3) continue;
            for (int u = first(low.x); u <= last(high.x, plane_.grid.cells_u); ++u)
                add_piece(nodes_[cell_index(u, v)], clip_to_square(row, Vec2(u, v), 1));
        }
    }

    static void add_piece(Node& node, const ClipPolygon& piece) {
        if (piece.count >= 3) node.pieces.push_back(piece);
    }

    [[nodiscard]] std::size_t cell_index(int u, int v) const {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(plane_.grid.cells_u) +
               static_cast<std::size_t>(u);
    }

    [[nodiscard]] static Extent extent_of(const Node& node) {
        Extent extent;
        for (const ClipPolygon& piece : node.pieces) {
            for_triangles(piece,
                          [&](const ClipCorner& a, const ClipCorner& b, const ClipCorner& c, float area) {
                              extent.area += area;
                              extent.moment += area / 3.0F * (a.cell + b.cell + c.cell);
                          });
        }
        return extent;
    }
    [[nodiscard]] static bool is_empty(const Node& node) {
        return extent_of(node).area < sliver_share * node.size * node.size;
    }

    // --- refinement

    void refine(Index n) {
        const float edge = nodes_[n].size * std::max(glm::length(plane_.edge_u), glm::length(plane_.edge_v));
        if (0.5F * edge < config_.finest_m || is_empty(nodes_[n])) return;
        const PatchShape shape = shape_of(nodes_[n]);
        if (!config_.is_too_coarse(shape, surface_.body, side_)) return;
        divide(n);
        for (Index q = 0; q < 4; ++q) refine(nodes_[n].first_child + q);
    }

    void divide(Index n) {
        const auto first = static_cast<Index>(nodes_.size());
        const float half = 0.5F * nodes_[n].size;
        for (Index q = 0; q < 4; ++q) {
            Node child{nodes_[n].low + half * CellTree::corner_of_quarter(q), half, {}, no_index};
            for (const ClipPolygon& piece : nodes_[n].pieces)
                add_piece(child, clip_to_square(piece, child.low, half));
            nodes_.push_back(std::move(child));
        }
        nodes_[n].first_child = first;
        nodes_[n].pieces.clear();
    }

    [[nodiscard]] Index leaf_at(const Vec2& at) const {
        auto n = static_cast<Index>(cell_index(static_cast<int>(at.x), static_cast<int>(at.y)));
        while (!nodes_[n].is_leaf()) {
            const Vec2 middle = nodes_[n].low + 0.5F * nodes_[n].size;
            n = nodes_[n].first_child + (at.x >= middle.x ? 1 : 0) + (at.y >= middle.y ? 2 : 0);
        }
        return n;
    }

    /// Divides leaves that are more than twice as large as a neighbour, so that interpolation meets few.
    /// Returns whether there were any.
    bool balance() {
        std::vector<Index> too_large;
        const Vec2 end(plane_.grid.cells_u, plane_.grid.cells_v);
        for (const Node& node : nodes_) {
            if (!node.is_leaf() || node.size > 0.25F) continue;
            const Vec2 centre = node.low + 0.5F * node.size;
            for (const auto& [du, dv] : neighbours) {
                const Vec2 at = centre + node.size * Vec2(du, dv);
                if (at.x < 0 || at.y < 0 || at.x >= end.x || at.y >= end.y) continue;
                const Index neighbour = leaf_at(at);
                if (nodes_[neighbour].size > 2 * node.size && !is_empty(nodes_[neighbour]))
                    too_large.push_back(neighbour);
            }
        }
        std::sort(too_large.begin(), too_large.end());
        too_large.erase(std::unique(too_large.begin(), too_large.end()), too_large.end());
        for (const Index n : too_large) divide(n);
        return !too_large.empty();
    }

    // --- result

    SurfaceShapes emit() const {
        SurfaceShapes out;
        out.grid = plane_.grid;
        out.tree.cells_u = plane_.grid.cells_u;
        out.tree.cells_v = plane_.grid.cells_v;
        out.tree.cells.assign(cell_index(0, plane_.grid.cells_v), no_index);
        constexpr int tile = 4;
        for (int v0 = 0; v0 < plane_.grid.cells_v; v0 += tile)
            for (int u0 = 0; u0 < plane_.grid.cells_u; u0 += tile)
                for (int v = v0; v < std::min(v0 + tile, plane_.grid.cells_v); ++v)
                    for (int u = u0; u < std::min(u0 + tile, plane_.grid.cells_u); ++u)
                        out.tree.cells[cell_index(u, v)] = emit_node(nodes_[cell_index(u, v)], out);
        return out;
    }

    Index emit_node(const Node& node, SurfaceShapes& out) const {
        if (node.is_leaf()) {
            if (is_empty(node)) return no_index;
            out.shapes.push_back(shape_of(node));
            if (world_.materials[surface_.material].texture != no_index)
                out.shapes.back().texture_mean = mean_colour(node);
            return static_cast<Index>(out.shapes.size() - 1);
        }
        const auto quarter = static_cast<Index>(out.tree.quarters.size());
        out.tree.quarters.emplace_back();
        for (Index q = 0; q < 4; ++q) {
            const Index entry = emit_node(nodes_[node.first_child + q], out);
            out.tree.quarters[quarter][q] = entry;
        }
        return CellTree::divided | quarter;
    }

    [[nodiscard]] PatchShape shape_of(const Node& node) const {
        const Extent extent = extent_of(node);
        const float whole = node.size * node.size;
        PatchShape shape;
        shape.normal = surface_.normal;
        shape.area_m2 = std::min(extent.area, whole) * plane_.cell_area;
        shape.centre = to_body(extent.moment / extent.area);
        shape.origin = to_body(node.low);
        shape.edge_u = node.size * plane_.edge_u;
        shape.edge_v = node.size * plane_.edge_v;
        if (extent.area < whole_cell_share * whole) add_fragments(node, extent.area, shape);
        return shape;
    }

    void add_fragments(const Node& node, float total, PatchShape& shape) const {
        float sum = 0;
        for (const ClipPolygon& piece : node.pieces) {
            for_triangles(
                piece, [&](const ClipCorner& a, const ClipCorner& b, const ClipCorner& c, float area) {
                    sum += area;
                    const Vec3 corner = to_body(a.cell);
                    shape.fragments.push_back({corner, to_body(b.cell) - corner, to_body(c.cell) - corner,
                                               surface_.normal, sum / total});
                });
        }
        shape.fragments.back().cumulative_share = 1;
    }

    [[nodiscard]] Rgb mean_colour(const Node& node) const {
        const Texture& texture = world_.textures[world_.materials[surface_.material].texture];
        Rgb colour(0);
        float sum = 0;
        for (const ClipPolygon& piece : node.pieces) {
            for_triangles(piece,
                          [&](const ClipCorner& a, const ClipCorner& b, const ClipCorner& c, float area) {
                              const Index t = piece.triangle;
                              colour += area * mean_texture(texture, {uv_at(t, a), uv_at(t, b), uv_at(t, c)});
                              sum += area;
                          });
        }
        return colour / sum;
    }

    [[nodiscard]] Vec2 uv_at(Index t, const ClipCorner& corner) const {
        Vec2 uv(0);
        for (std::size_t k = 0; k < 3; ++k)
            uv += corner.barycentric[static_cast<int>(k)] *
                  body_.texture_coordinates[body_.triangles[t].vertices[k]];
        return uv;
    }

    const World& world_;
    const Body& body_;
    const Surface& surface_;
    Side side_;
    const MeshConfig& config_;
    PlaneGrid plane_;
    std::vector<Node> nodes_;  // the first ones are the cells
};

}  // namespace

SurfaceShapes divide_flat(const World& world, const Surface& surface, Side side, const MeshConfig& config) {
    return FlatDivision(world, surface, side, config).run();
}

Rgb mean_texture(const Texture& texture, const std::array<Vec2, 3>& corners) {
    // Midpoints of the 16 similar triangles that a division into quarters, twice, gives.
    constexpr int side = 4;
    Rgb sum(0);
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < 2 * (side - i) - 1; ++j) {
            const float a = (static_cast<float>(i) + (j % 2 == 0 ? 1.0F : 2.0F) / 3.0F) / side;
            const int row = j / 2;
            const float b = (static_cast<float>(row) + (j % 2 == 0 ? 1.0F : 2.0F) / 3.0F) / side;
            sum += texture.at((1 - a - b) * corners[0] + a * corners[1] + b * corners[2]);
        }
    }
    return sum / static_cast<float>(side * side);
}

}  // namespace afterglow
