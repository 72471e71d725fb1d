#include "solver/mesh/cell_tree.h"

#include <algorithm>

namespace afterglow {

CellPolygon::Extent CellPolygon::extent() const {
    Extent out;
    Vec2 moment(0);
    for (std::size_t i = 1; i + 1 < count; ++i) {
        const Vec2 ab = corners[i] - corners[0], ac = corners[i + 1] - corners[0];
        const float area = 0.5F * std::abs(ab.x * ac.y - ab.y * ac.x);
        out.area += area;
        moment += area / 3.0F * (ab + ac);
    }
    if (out.area > 0) out.centre = corners[0] + moment / out.area;
    return out;
}

CellPolygon CellPolygon::part(const GridLine& line, float sign) const {
    CellPolygon out;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2 &a = corners[i], &b = corners[i + 1 < count ? i + 1 : 0];
        const float da = sign * line.distance(a), db = sign * line.distance(b);
        if (da >= 0) out.add(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) out.add(glm::mix(a, b, da / (da - db)));
    }
    return out;
}

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
    while (is_split(leaf.item)) {
        const Split& node = splits[leaf.item & ~split];
        leaf.item = node.part[node.line.distance(at) >= 0 ? 1 : 0];
    }
    return leaf;
}

bool CellTree::is_divided_between(const Vec2& a, const Vec2& b) const {
    if (dividers.empty()) return false;
    const Vec2 end(cells_u, cells_v);
    const Vec2 low = glm::clamp(glm::min(a, b), Vec2(0), end),
               high = glm::clamp(glm::max(a, b), Vec2(0), end);
    bool found = false;
    for_cells(low, high, [&](int u, int v) {
        const std::size_t cell = cell_index(u, v);
        for (std::size_t k = first_divider[cell]; k < first_divider[cell + 1] && !found; ++k)
            found = crosses(dividers[k], a, b);
    });
    return found;
}

}  // namespace afterglow
