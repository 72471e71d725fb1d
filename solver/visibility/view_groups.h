#pragma once

#include <vector>

#include "solver/visibility/sight_lines.h"
#include "solver/visibility/temporal_bsp.h"

namespace afterglow {

/// Which neighbouring patches share one temporal graph.
enum class Grouping {
    patch,        ///< none: one graph a patch
    block,        ///< the 16 patches whose lines are traced together
    four_blocks,  ///< up to 64 of one surface side
    surface,      ///< all blocks of one surface side
};

/// Some static patches that look as one.
struct ViewGroup {
    std::size_t first_block = 0, last_block = 0;  ///< [first, last)
    std::uint32_t lanes = 0xFFFF;                 ///< which patches of each block
    Box origins;                                  ///< holds the origins of all their lines
    Viewpoint viewpoint;                          ///< so do this ball and this box
};

/// The groups of all static blocks in the blocks' order. A block that holds patches of several surfaces
/// belongs to the surface of its first. Thread-safety: pure.
std::vector<ViewGroup> make_view_groups(const PatchMesh& mesh, const SightLines& sight, Grouping grouping);

}  // namespace afterglow
