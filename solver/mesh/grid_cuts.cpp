#include "solver/mesh/grid_cuts.h"

#include <algorithm>
#include <cmath>

namespace afterglow {

namespace {

constexpr float tolerance_per_lift = 0.1F;  // what rounding leaves of a place in the scene, and room
// Walls around a floor divide nothing of it, and a patch should be whole for closed forms; but where one
// leans, lines from points beneath it must not start beyond.
constexpr float upright_kerf_per_lift = 1.4F;

struct CutLayer {
    const PlaneGrid& plane;
    GridCuts out;
    float upright_kerf_m;
    Vec2 end, tolerance;  // the far corner of the grid; in cells

    CutLayer(const PlaneGrid& p, float lift_m)
        : plane(p),
          upright_kerf_m(upright_kerf_per_lift * lift_m),
          end(p.grid.cells_u, p.grid.cells_v),
          tolerance(tolerance_per_lift * lift_m / p.cell_m) {
        out.tolerance_m = tolerance_per_lift * lift_m;
    }

    [[nodiscard]] bool is_on_border(const GridSegment& s) const {
        for (int axis = 0; axis < 2; ++axis)
            for (const float border : {0.0F, end[axis]})
                if (std::abs(s.from[axis] - border) <= tolerance[axis] &&
                    std::abs(s.to[axis] - border) <= tolerance[axis])
                    return true;
        return false;
    }

    void add(const Cut& cut) {
        const auto segment =
            clip({plane.grid.cell_at(cut.from), plane.grid.cell_at(cut.to)}, -tolerance, end + tolerance);
        if (!segment || glm::length(plane.cell_m * (segment->to - segment->from)) <= out.tolerance_m) return;
        const bool on_border = is_on_border(*segment);
        if (on_border && cut.kerf_m < upright_kerf_m) return;
        const auto number = static_cast<Index>(out.list.size());
        out.list.push_back(
            {*segment, line_through(segment->from, segment->to, plane.cell_m), cut.kerf_m, on_border});
        if (out.of_cell.empty())
            out.of_cell.resize(static_cast<std::size_t>(end.x) * static_cast<std::size_t>(end.y));
        // Row by row, since a cut across the grid touches few of the cells in its bounds.
        const auto cell = [](float x, float cells) {
            return static_cast<int>(std::clamp(x, 0.0F, cells - 1));
        };
        const Vec2 low = glm::min(segment->from, segment->to) - tolerance;
        const Vec2 high = glm::max(segment->from, segment->to) + tolerance;
        for (int v = cell(low.y, end.y); v <= cell(high.y, end.y); ++v) {
            const auto row = clip(*segment, Vec2(low.x, static_cast<float>(v) - tolerance.y),
                                  Vec2(high.x, static_cast<float>(v + 1) + tolerance.y));
            if (!row) continue;
            const auto [u0, u1] = std::minmax({row->from.x, row->to.x});
            for (int u = cell(u0 - tolerance.x, end.x); u <= cell(u1 + tolerance.x, end.x); ++u)
                out.of_cell[static_cast<std::size_t>(v) * static_cast<std::size_t>(end.x) +
                            static_cast<std::size_t>(u)]
                    .push_back(number);
        }
    }
};

}  // namespace

std::vector<Index> GridCuts::touching(std::span<const Index> among, const CellSquare& square) const {
    const Vec2 tolerance = tolerance_m / square.cell_m;
    std::vector<Index> touched;
    for (const Index c : among)
        if (clip(list[c].segment, square.low - tolerance, square.low + square.size + tolerance))
            touched.push_back(c);
    return touched;
}

GridCuts lay_cuts(const PlaneGrid& plane, std::span<const Cut> cuts, Side side, float lift_m) {
    CutLayer layer(plane, lift_m);
    for (const Cut& cut : cuts)
        if (cut.stands_on[static_cast<std::size_t>(side)]) layer.add(cut);
    return std::move(layer.out);
}

void add_dividers(CellTree& tree, const GridCuts& cuts) {
    if (std::all_of(cuts.list.begin(), cuts.list.end(), [](const CellCut& cut) { return cut.on_border; }))
        return;
    tree.first_divider.push_back(0);
    for (const auto& of_cell : cuts.of_cell) {
        for (const Index c : of_cell)
            if (!cuts.list[c].on_border) tree.dividers.push_back(cuts.list[c].segment);
        tree.first_divider.push_back(tree.dividers.size());
    }
}

}  // namespace afterglow
