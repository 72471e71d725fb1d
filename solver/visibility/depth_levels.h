#pragma once

#include <span>
#include <vector>

#include "solver/base/math.h"

namespace afterglow {

/// Successors by node: those that the node may hide.
using Successors = std::vector<std::vector<Index>>;

/// A directed graph in levels. Nodes that hide each other in a circle are one *component*; the level of a
/// component is the longest path of ancestors that leads to it. Nothing hides anything of its own level, so
/// the order within a level does not matter.
struct DepthLevels {
    std::vector<Index> component;  ///< by node: the least node of its component
    std::vector<Index> level;      ///< by node

    bool operator==(const DepthLevels&) const = default;
};

/// Maximum-level topological sorting. Source: Tost and Pueyo 1993, section 3; components: Tarjan 1972.
/// Thread-safety: pure.
DepthLevels sort_by_levels(const Successors& successors);

/// The same after edges have come or gone: `heads` are the nodes that the changed edges lead to. Only they
/// and what can be reached from them is sorted anew; returns how many nodes that is. Nothing else can have
/// changed: a node's component and level depend on its ancestors alone.
std::size_t resort_by_levels(DepthLevels& levels, const Successors& successors, std::span<const Index> heads);

/// All nodes front to back: by level, the nodes of a component together.
std::vector<Index> front_to_back(const DepthLevels& levels);

}  // namespace afterglow
