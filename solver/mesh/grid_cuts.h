#pragma once

#include <span>
#include <vector>

#include "solver/mesh/cuts.h"
#include "solver/mesh/plane_grid.h"
#include "solver/mesh/split_cell.h"

namespace afterglow {

/// The cuts of one side of a surface, in its grid, and the cells they touch.
struct GridCuts {
    std::vector<CellCut> list;
    std::vector<std::vector<Index>> of_cell;  ///< by CellTree::cell_index; empty without cuts
    float tolerance_m = 0;                    ///< see CellSquare

    /// Those of `among` that touch a square.
    [[nodiscard]] std::vector<Index> touching(std::span<const Index> among, const CellSquare& square) const;
};

/// Cuts along the outer border of the grid are left out where what stands there is upright.
/// Thread-safety: pure.
GridCuts lay_cuts(const PlaneGrid& plane, std::span<const Cut> cuts, Side side, float lift_m);

/// Gives the tree of the same grid its dividers: the cuts that are not along its border.
void add_dividers(CellTree& tree, const GridCuts& cuts);

}  // namespace afterglow
