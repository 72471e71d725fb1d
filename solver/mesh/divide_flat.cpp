#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "solver/mesh/grid_cuts.h"
#include "solver/mesh/patch_shape.h"
#include "solver/mesh/plane_grid.h"
#include "solver/mesh/split_cell.h"

namespace afterglow {

namespace {

constexpr float whole_cell_share = 0.9999F;  // covered by this much, a cell counts as a whole rectangle
constexpr std::array<std::array<int, 2>, 8> neighbours{
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
constexpr float smallest_crowded = 0.125F;  // cells with too many cuts are halved down to this
constexpr float sliver_share = 1e-5F;       // below it, the neighbouring cell answers for the sliver

/// A cell or a quarter of one on its way to patches.
struct Node {
    Vec2 low{0};
    float size = 1;
    std::vector<ClipPolygon> pieces;  // of the surface's triangles
    std::vector<Index> cuts;          // that touch it
    Index first_child = no_index;     // of four, once divided

    [[nodiscard]] bool is_leaf() const { return first_child == no_index; }
};

/// Area in cells, its first moment, and its bounds.
struct Extent {
    float area = 0;
    Vec2 moment{0};
    Vec2 low{1e30F}, high{-1e30F};

    void add(const ClipCorner& c) {
        low = glm::min(low, c.cell);
        high = glm::max(high, c.cell);
    }
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
    FlatDivision(const World& world, const Surface& surface, const SurfaceSide& on, const MeshConfig& config)
        : world_(world),
          body_(world.bodies[surface.body]),
          surface_(surface),
          side_(on.side),
          config_(config),
          plane_(lay_grid(body_, surface, config.patch_size_m)),
          cuts_(lay_cuts(plane_, on.cuts, on.side, on.lift_m)) {
        for (int v = 0; v < plane_.grid.cells_v; ++v) {
            for (int u = 0; u < plane_.grid.cells_u; ++u) {
                nodes_.push_back({Vec2(u, v), 1, {}, {}, no_index});
                if (!cuts_.list.empty()) nodes_.back().cuts = cuts_.of_cell[cell_index(u, v)];
            }
        }
    }

    SurfaceShapes run() {
        for (const Index t : surface_.triangles) add_triangle(t);
        for (Index root = 0, roots = static_cast<Index>(nodes_.size()); root < roots; ++root) refine(root);
        while (balance()) {
        }
        return emit();
    }

  private:
    void add_triangle(Index t) {
        ClipPolygon whole;
        whole.triangle = t;
        Vec2 low(1e30F), high(-1e30F);
        for (std::size_t k = 0; k < 3; ++k) {
            ClipCorner corner{plane_.grid.cell_at(body_.positions[body_.triangles[t].vertices[k]]), Vec3(0)};
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

    [[nodiscard]] static Extent extent_of(const std::vector<ClipPolygon>& pieces) {
        Extent extent;
        for (const ClipPolygon& piece : pieces) {
            for_triangles(piece,
                          [&](const ClipCorner& a, const ClipCorner& b, const ClipCorner& c, float area) {
                              extent.area += area;
                              extent.moment += area / 3.0F * (a.cell + b.cell + c.cell);
                              for (const ClipCorner& corner : {a, b, c}) extent.add(corner);
                          });
        }
        return extent;
    }
    [[nodiscard]] static bool is_sliver(const std::vector<ClipPolygon>& pieces, float size) {
        return extent_of(pieces).area < sliver_share * size * size;
    }
    [[nodiscard]] static bool is_empty(const Node& node) { return is_sliver(node.pieces, node.size); }

    [[nodiscard]] CellSquare square_of(const Node& node) const {
        return {node.low, node.size, plane_.cell_m, cuts_.tolerance_m};
    }
    [[nodiscard]] SplitCell parts_of(const Node& node) const {
        if (node.cuts.empty()) return {0, {}, {{node.pieces, {}}}};
        std::vector<CellCut> cuts;
        for (const Index c : node.cuts) cuts.push_back(cuts_.list[c]);
        return split_cell(node.pieces, cuts, square_of(node));
    }

    // --- refinement

    void refine(Index n) {
        if (is_empty(nodes_[n]) || !(is_crowded(nodes_[n]) || is_too_coarse(nodes_[n]))) return;
        divide(n);
        for (Index q = 0; q < 4; ++q) refine(nodes_[n].first_child + q);
    }

    [[nodiscard]] static bool is_crowded(const Node& node) {
        return node.cuts.size() > most_cuts_in_cell && node.size > smallest_crowded;
    }

    [[nodiscard]] bool is_too_coarse(const Node& node) const {
        const float edge = node.size * std::max(plane_.cell_m.x, plane_.cell_m.y);
        if (!config_.is_too_coarse || 0.5F * edge < config_.finest_m) return false;
        const auto is_too_coarse_in = [&](const CellPart& part) {
            const auto shape = shape_of(node, part);
            return shape && config_.is_too_coarse(*shape, surface_.body, side_);
        };
        const SplitCell split = parts_of(node);
        return std::any_of(split.parts.begin(), split.parts.end(), is_too_coarse_in);
    }

    void divide(Index n) {
        const auto first = static_cast<Index>(nodes_.size());
        const float half = 0.5F * nodes_[n].size;
        for (Index q = 0; q < 4; ++q) {
            Node child{nodes_[n].low + half * CellTree::corner_of_quarter(q), half, {}, {}, no_index};
            for (const ClipPolygon& piece : nodes_[n].pieces)
                add_piece(child, clip_to_square(piece, child.low, half));
            child.cuts = cuts_.touching(nodes_[n].cuts, square_of(child));
            nodes_.push_back(std::move(child));
        }
        nodes_[n].first_child = first;
        nodes_[n].pieces.clear();
        nodes_[n].cuts.clear();
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
        add_dividers(out.tree, cuts_);
        return out;
    }

    Index emit_node(const Node& node, SurfaceShapes& out) const {
        if (node.is_leaf()) return is_empty(node) ? no_index : emit_leaf(node, out);
        const auto quarter = static_cast<Index>(out.tree.quarters.size());
        out.tree.quarters.emplace_back();
        for (Index q = 0; q < 4; ++q) {
            const Index entry = emit_node(nodes_[node.first_child + q], out);
            out.tree.quarters[quarter][q] = entry;
        }
        return CellTree::divided | quarter;
    }

    Index emit_leaf(const Node& node, SurfaceShapes& out) const {
        const SplitCell split = parts_of(node);
        std::vector<Index> item_of_part;
        for (const CellPart& part : split.parts) {
            auto shape = shape_of(node, part);
            item_of_part.push_back(shape ? static_cast<Index>(out.shapes.size()) : no_index);
            if (!shape) continue;
            if (world_.materials[surface_.material].texture != no_index)
                shape->texture_mean = mean_colour(part);
            out.shapes.push_back(std::move(*shape));
        }
        const auto first = static_cast<Index>(out.tree.splits.size());
        const auto entry = [&](Index local) {
            if (local == no_index) return local;
            return CellTree::is_split(local) ? local + first : item_of_part[local];
        };
        for (CellTree::Split line : split.splits) {
            line.part = {entry(line.part[0]), entry(line.part[1])};
            out.tree.splits.push_back(line);
        }
        return entry(split.root);
    }

    /// Nothing for slivers: too small, or no wider than what must be kept off.
    [[nodiscard]] std::optional<PatchShape> shape_of(const Node& node, const CellPart& part) const {
        const Extent extent = extent_of(part.pieces);
        const float whole = node.size * node.size;
        if (extent.area < sliver_share * whole) return std::nullopt;
        PatchShape shape;
        shape.normal = surface_.normal;
        shape.area_m2 = std::min(extent.area, whole) * plane_.cell_area_m2();
        shape.centre = plane_.to_body(extent.moment / extent.area);
        const std::vector<ClipPolygon> kept = kept_of(part);
        const Extent kept_extent = extent_of(kept);
        if (is_sliver(kept, node.size)) return std::nullopt;
        const Vec2 across = kept_extent.high - kept_extent.low;
        const bool is_whole =
            kept_extent.area >= whole_cell_share * across.x * across.y && is_within(kept_extent, part.bounds);
        // The size of what a border cuts off is that of its cell: it stands among such.
        const bool has_own_size = is_whole || !part.bounds.empty();
        shape.origin = plane_.to_body(has_own_size ? kept_extent.low : node.low);
        shape.edge_u = (has_own_size ? across.x : node.size) * plane_.edge_u;
        shape.edge_v = (has_own_size ? across.y : node.size) * plane_.edge_v;
        if (!is_whole) add_fragments(kept, kept_extent.area, shape);
        return shape;
    }

    /// Whether the corners of a part's bounds keep off its cuts: one may clip no more than a corner.
    [[nodiscard]] static bool is_within(const Extent& e, const std::vector<PartBound>& bounds) {
        return std::all_of(bounds.begin(), bounds.end(), [&](const PartBound& bound) {
            const float sign = bound.keep == Keep::above ? 1.0F : -1.0F;
            const std::array corners{e.low, Vec2(e.high.x, e.low.y), e.high, Vec2(e.low.x, e.high.y)};
            return std::all_of(corners.begin(), corners.end(), [&](const Vec2& corner) {
                return sign * bound.line.distance(corner) >= 0.9F * bound.kerf_m;
            });
        });
    }

    /// What of a part is far enough from the cuts.
    [[nodiscard]] static std::vector<ClipPolygon> kept_of(const CellPart& part) {
        std::vector<ClipPolygon> kept = part.pieces;
        for (const PartBound& bound : part.bounds) {
            for (ClipPolygon& piece : kept) piece = clip(piece, bound.line, bound.kerf_m, bound.keep);
            std::erase_if(kept, [](const ClipPolygon& piece) { return piece.count < 3; });
        }
        return kept;
    }

    void add_fragments(const std::vector<ClipPolygon>& pieces, float total, PatchShape& shape) const {
        float sum = 0;
        for (const ClipPolygon& piece : pieces) {
            for_triangles(piece, [&](const ClipCorner& a, const ClipCorner& b, const ClipCorner& c,
                                     float area) {
                sum += area;
                const Vec3 corner = plane_.to_body(a.cell);
                shape.fragments.push_back({corner, plane_.to_body(b.cell) - corner,
                                           plane_.to_body(c.cell) - corner, surface_.normal, sum / total});
            });
        }
        shape.fragments.back().cumulative_share = 1;
    }

    [[nodiscard]] Rgb mean_colour(const CellPart& part) const {
        const Texture& texture = world_.textures[world_.materials[surface_.material].texture];
        Rgb colour(0);
        float sum = 0;
        for (const ClipPolygon& piece : part.pieces) {
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
    GridCuts cuts_;
    std::vector<Node> nodes_;  // the first ones are the cells
};

}  // namespace

SurfaceShapes divide_flat(const World& world, const Surface& surface, const SurfaceSide& on,
                          const MeshConfig& config) {
    return FlatDivision(world, surface, on, config).run();
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
