#include "solver/mesh/cell_tree.h"

#include <algorithm>

namespace afterglow {

CellTree::Leaf CellTree::leaf_at(const Vec2& at) const {
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
    return leaf;
}

}  // namespace afterglow
