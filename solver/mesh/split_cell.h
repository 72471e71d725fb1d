#pragma once

#include <span>
#include <vector>

#include "solver/mesh/cell_tree.h"
#include "solver/mesh/clip.h"

namespace afterglow {

/// No cell is split along more cuts than this; the longest count.
inline constexpr std::size_t most_cuts_in_cell = 32;

/// A cut in the grid of its surface.
struct CellCut {
    GridSegment segment;
    GridLine line;     ///< through the segment
    float kerf_m = 0;  ///< see Cut
    /// Along the outer border of the grid: it divides nothing, but points keep off it.
    bool on_border = false;
};

/// The side of a cut's line on which a part of a cell lies, and how far its points must keep off.
struct PartBound {
    GridLine line;
    Keep keep = Keep::below;
    float kerf_m = 0;
};

/// A part of a cell with all its surface on one side of each cut.
struct CellPart {
    std::vector<ClipPolygon> pieces;  ///< of the surface's triangles
    std::vector<PartBound> bounds;
};

/// A cell that is split along its cuts, as a tree of lines: entries are parts, or CellTree::split and an
/// index.
struct SplitCell {
    Index root = 0;
    std::vector<CellTree::Split> splits;
    std::vector<CellPart> parts;
};

/// The square of the grid that a cell fills, and what it is in metres.
struct CellSquare {
    Vec2 low{0};
    float size = 1;
    Vec2 cell_m{1};  ///< edges of a cell of size 1
    /// Nearer than this, a cut lies on the border and splits nothing: what rounding can tell, metres.
    float tolerance_m = 0;
};

/// Splits the surface within a cell along the cuts that pass through it, the longest first; the line of a cut
/// that ends in the cell is drawn on to where it meets another one or the border. At most most_cuts_in_cell,
/// and CellTree::most_splits within one another. Source: Fuchs, Kedem and Naylor 1980 (binary space
/// partition). Thread-safety: pure.
SplitCell split_cell(std::vector<ClipPolygon> pieces, std::span<const CellCut> cuts,
                     const CellSquare& square);

}  // namespace afterglow
