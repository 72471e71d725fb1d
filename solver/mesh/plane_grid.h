#pragma once

#include "solver/mesh/patch_mesh.h"

namespace afterglow {

/// The grid of a flat surface and its cells' edges, in the body's frame, metres.
struct PlaneGrid {
    SurfaceGrid grid;
    Vec3 edge_u{0}, edge_v{0};  ///< of one cell
    Vec2 cell_m{0};             ///< their lengths

    [[nodiscard]] float cell_area_m2() const { return cell_m.x * cell_m.y; }
    [[nodiscard]] Vec3 to_body(const Vec2& cell) const {
        return grid.origin + cell.x * edge_u + cell.y * edge_v;
    }
};

/// A grid over a flat surface along its longest border edge, so that rectangles fall into whole cells; no
/// cell is longer than `size_m`. Errors: too_large past 4 million cells. Thread-safety: pure.
PlaneGrid lay_grid(const Body& body, const Surface& surface, float size_m);

}  // namespace afterglow
