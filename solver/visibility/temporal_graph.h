#pragma once

#include <vector>

#include "solver/visibility/depth_levels.h"
#include "solver/visibility/spacetime_extent.h"

namespace afterglow {

/// One object may hide another for some time.
struct Hiding {
    Index to = 0;
    TimeSpan when;
};

/// The temporal graph of depth priority of some objects as seen from some viewpoints: who may hide whom and
/// when, and the levels at one time. One thread at a time.
struct TemporalGraph {
    std::vector<std::vector<Hiding>> adjacency;  ///< by object, for all times

    double since_s = 0, until_s = 0;  ///< the levels below hold from `since_s` up to `until_s`
    Successors active;                ///< the adjacencies that hold now, in rising order
    DepthLevels levels;
    std::vector<Index> order;  ///< all objects front to back, the members of a circle together

    struct Event {
        double time_s = 0;
        Index from = 0, to = 0;
        enum class Kind { begins, ends } kind = Kind::begins;
    };
    std::vector<Event> events;  ///< in order of time
    std::size_t passed = 0;     ///< how many of them are not after `since_s`
};

/// A graph of given adjacencies at time −∞. Spans of the same two objects must not touch each other.
TemporalGraph make_temporal_graph(std::vector<std::vector<Hiding>> adjacency);

/// Who may hide whom of some moving extents as seen from a box of viewpoints.
std::vector<std::vector<Hiding>> find_adjacencies(std::span<const SpacetimeExtent> extents,
                                                  const SpacetimeExtent& viewpoints, const TimeTree& times);

/// What an update had to do.
struct GraphWork {
    std::uint64_t events = 0;        ///< adjacencies that came or went
    std::uint64_t nodes_sorted = 0;  ///< objects whose levels were found anew
};

/// Brings the graph to another time, before or after: nothing is done while no adjacency comes or goes, and
/// only what can be reached from those that do is sorted anew. The levels equal those of sort_by_levels.
/// Source: Tost and Pueyo 1993, section 3; Tost 1991.
GraphWork update(TemporalGraph& graph, double time_s);

}  // namespace afterglow
