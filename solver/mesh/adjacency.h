#pragma once

#include <array>
#include <vector>

#include "solver/scene/world.h"

namespace afterglow {

/// Which triangles of a body share an edge that no third one touches. Vertices at the same position count as
/// one, since files split them at creases and texture seams.
struct Adjacency {
    std::vector<std::size_t> begin;  ///< size triangles + 1
    std::vector<Index> neighbour;    ///< triangles across an edge, by triangle

    /// Welded vertices, three a triangle: equal numbers stand at the same position.
    std::vector<std::array<Index, 3>> welded;
};

/// Cost: O(n log n). Thread-safety: pure.
Adjacency find_adjacency(const Body& body);

}  // namespace afterglow
