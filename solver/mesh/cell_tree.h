#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "solver/base/math.h"
#include "solver/mesh/grid_line.h"

namespace afterglow {

/// A convex part of a grid, in cell coordinates.
struct CellPolygon {
    /// A square cut `CellTree::most_splits` times has one corner more for each.
    std::array<Vec2, 20> corners;
    std::size_t count = 0;

    void add(const Vec2& c) {
        if (count < corners.size()) corners[count++] = c;
    }
    struct Extent {
        float area = 0;  ///< in cells
        Vec2 centre{0};  ///< of gravity
    };
    [[nodiscard]] Extent extent() const;
    /// The part below (−1) or above (+1) a line.
    [[nodiscard]] CellPolygon part(const GridLine& line, float sign) const;
};

/// A grid of unit cells, each of which may be divided in four, and each quarter again; what is not divided
/// may be split along lines. In the end stands an item or nothing. Across the grid run *dividers*: light
/// differs from one side of them to the other. Coordinates run from 0 to cells_u and cells_v. Thread-safety:
/// const calls are pure.
struct CellTree {
    /// Mark entries that are divided or split; the rest is an index into `quarters` or `splits`. Items must
    /// be below both.
    static constexpr Index divided = 0x80000000U;
    static constexpr Index split = 0x40000000U;
    /// No leaf is split more often than this, one split within another.
    static constexpr int most_splits = 16;

    struct Split {
        GridLine line;
        std::array<Index, 2> part{};  ///< entries: below the line, above it
    };

    int cells_u = 0, cells_v = 0;
    std::vector<Index> cells;  ///< by cell v · cells_u + u: an item, no_index for nothing, divided or split
    std::vector<std::array<Index, 4>> quarters;  ///< likewise, in the order (0,0) (1,0) (0,1) (1,1) of (u, v)
    std::vector<Split> splits;
    std::vector<GridSegment> dividers;       ///< cell by cell, so that some stand there several times
    std::vector<std::size_t> first_divider;  ///< by cell, size cells + 1; empty without dividers

    [[nodiscard]] bool empty() const { return cells.empty(); }
    static bool is_divided(Index entry) { return entry != no_index && (entry & divided) != 0; }
    static bool is_split(Index entry) { return (entry & (divided | split)) == split; }

    /// Where a quarter's corner lies, in quarters.
    static Vec2 corner_of_quarter(std::size_t q) { return {q % 2 == 1 ? 1 : 0, q >= 2 ? 1 : 0}; }

    struct Leaf {
        Index item = no_index;
        Vec2 low{0};     ///< corner of its square
        float size = 1;  ///< 1, 1/2, 1/4 …
    };
    /// The leaf at a place; places outside the grid belong to its border. The tree must not be empty.
    [[nodiscard]] Leaf leaf_at(const Vec2& at) const;

    /// Whether a divider crosses the straight way between two places.
    [[nodiscard]] bool is_divided_between(const Vec2& a, const Vec2& b) const;

    /// Calls `visit(item, area, centre)` for every item that shares area with a rectangle, in a fixed order;
    /// `centre` is that of the shared part.
    template <class Visit>
    void for_overlaps(const Vec2& low, const Vec2& high, const Visit& visit) const {
        for_cells(low, high, [&](int u, int v) {
            visit_overlaps(cells[cell_index(u, v)], Vec2(u, v), 1, low, high, visit);
        });
    }

    [[nodiscard]] std::size_t cell_index(int u, int v) const {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(cells_u) + static_cast<std::size_t>(u);
    }

  private:
    template <class Visit>
    void for_cells(const Vec2& low, const Vec2& high, const Visit& visit) const {
        const int u1 = std::min(cells_u - 1, static_cast<int>(high.x));
        const int v1 = std::min(cells_v - 1, static_cast<int>(high.y));
        for (int v = std::clamp(static_cast<int>(low.y), 0, cells_v - 1); v <= v1; ++v)
            for (int u = std::clamp(static_cast<int>(low.x), 0, cells_u - 1); u <= u1; ++u) visit(u, v);
    }

    template <class Visit>
    void visit_overlaps(Index entry, const Vec2& corner, float size, const Vec2& low, const Vec2& high,
                        const Visit& visit) const {
        const Vec2 from = glm::max(low, corner), to = glm::min(high, corner + size);
        const Vec2 extent = to - from;
        if (extent.x <= 0 || extent.y <= 0 || entry == no_index) return;
        if (is_split(entry)) {
            CellPolygon polygon;
            for (const Vec2& c : {from, Vec2(to.x, from.y), to, Vec2(from.x, to.y)}) polygon.add(c);
            visit_parts(entry, polygon, visit);
            return;
        }
        if (!is_divided(entry)) {
            visit(entry, extent.x * extent.y, 0.5F * (from + to));
            return;
        }
        const auto& four = quarters[entry & ~divided];
        const float half = 0.5F * size;
        for (std::size_t q = 0; q < 4; ++q)
            visit_overlaps(four[q], corner + half * corner_of_quarter(q), half, low, high, visit);
    }

    template <class Visit>
    void visit_parts(Index entry, const CellPolygon& polygon, const Visit& visit) const {
        if (entry == no_index || polygon.count < 3) return;
        if (is_split(entry)) {
            const Split& node = splits[entry & ~split];
            visit_parts(node.part[0], polygon.part(node.line, -1), visit);
            visit_parts(node.part[1], polygon.part(node.line, 1), visit);
            return;
        }
        const CellPolygon::Extent extent = polygon.extent();
        if (extent.area > 0) visit(entry, extent.area, extent.centre);
    }
};

inline CellTree::Leaf CellTree::leaf_at(const Vec2& at) const {
    const int u = std::clamp(static_cast<int>(at.x), 0, cells_u - 1);
    const int v = std::clamp(static_cast<int>(at.y), 0, cells_v - 1);
    Leaf leaf{cells[cell_index(u, v)], Vec2(u, v), 1};
    while (is_divided(leaf.item)) {
        leaf.size *= 0.5F;
        const Vec2 middle = leaf.low + leaf.size;
        const std::size_t right = at.x >= middle.x ? 1 : 0, upper = at.y >= middle.y ? 1 : 0;
        leaf.item = quarters[leaf.item & ~divided][right + 2 * upper];
        leaf.low += leaf.size * Vec2(right, upper);
    }
    while (is_split(leaf.item)) {
        const Split& node = splits[leaf.item & ~split];
        leaf.item = node.part[node.line.distance(at) >= 0 ? 1 : 0];
    }
    return leaf;
}

}  // namespace afterglow
