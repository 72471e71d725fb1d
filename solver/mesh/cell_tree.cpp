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
