#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "solver/base/math.h"

namespace afterglow {

/// A grid of unit cells, each of which may be divided in four, and each quarter again. A leaf holds an item
/// or nothing. Coordinates run from 0 to cells_u and cells_v. Thread-safety: const calls are pure.
struct CellTree {
    /// Marks an entry that is divided; the rest of it is an index into `quarters`. Items must be below it.
    static constexpr Index divided = 0x80000000U;

    int cells_u = 0, cells_v = 0;
    std::vector<Index> cells;  ///< by cell v · cells_u + u: an item, no_index for nothing, or divided
    std::vector<std::array<Index, 4>> quarters;  ///< likewise, in the order (0,0) (1,0) (0,1) (1,1) of (u, v)

    [[nodiscard]] bool empty() const { return cells.empty(); }
    static bool is_divided(Index entry) { return entry != no_index && (entry & divided) != 0; }

    /// Where a quarter's corner lies, in quarters.
    static Vec2 corner_of_quarter(std::size_t q) { return {q % 2 == 1 ? 1 : 0, q >= 2 ? 1 : 0}; }

    struct Leaf {
        Index item = no_index;
        Vec2 low{0};     ///< its corner
        float size = 1;  ///< 1, 1/2, 1/4 …
    };
    /// The leaf at a place; places outside the grid belong to its border. The tree must not be empty.
    [[nodiscard]] Leaf leaf_at(const Vec2& at) const;

    /// Calls `visit(item, area)` for every item whose leaf shares area with a rectangle, in a fixed order.
    template <class Visit>
    void for_overlaps(const Vec2& low, const Vec2& high, const Visit& visit) const {
        const int u1 = std::min(cells_u - 1, static_cast<int>(high.x));
        const int v1 = std::min(cells_v - 1, static_cast<int>(high.y));
        for (int v = std::max(0, static_cast<int>(low.y)); v <= v1; ++v)
            for (int u = std::max(0, static_cast<int>(low.x)); u <= u1; ++u)
                visit_overlaps(cells[cell_index(u, v)], Vec2(u, v), 1, low, high, visit);
    }

    [[nodiscard]] std::size_t cell_index(int u, int v) const {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(cells_u) + static_cast<std::size_t>(u);
    }

  private:
    template <class Visit>
    void visit_overlaps(Index entry, const Vec2& corner, float size, const Vec2& low, const Vec2& high,
                        const Visit& visit) const {
        const Vec2 extent = glm::min(high, corner + size) - glm::max(low, corner);
        if (extent.x <= 0 || extent.y <= 0 || entry == no_index) return;
        if (!is_divided(entry)) {
            visit(entry, extent.x * extent.y);
            return;
        }
        const auto& four = quarters[entry & ~divided];
        const float half = 0.5F * size;
        for (std::size_t q = 0; q < 4; ++q)
            visit_overlaps(four[q], corner + half * corner_of_quarter(q), half, low, high, visit);
    }
};

}  // namespace afterglow
