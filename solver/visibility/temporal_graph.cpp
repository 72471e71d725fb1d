#include "solver/visibility/temporal_graph.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace afterglow {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Lets an adjacency hold or no longer hold.
void set_active(TemporalGraph& graph, const TemporalGraph::Event& event, TemporalGraph::Event::Kind kind) {
    std::vector<Index>& successors = graph.active[event.from];
    const auto at = std::lower_bound(successors.begin(), successors.end(), event.to);
    if (kind == TemporalGraph::Event::Kind::begins)
        successors.insert(at, event.to);
    else
        successors.erase(at);
}

TemporalGraph::Event::Kind opposite(TemporalGraph::Event::Kind kind) {
    using Kind = TemporalGraph::Event::Kind;
    return kind == Kind::begins ? Kind::ends : Kind::begins;
}

void set_bounds(TemporalGraph& graph) {
    graph.since_s = graph.passed == 0 ? -never : graph.events[graph.passed - 1].time_s;
    graph.until_s = graph.passed == graph.events.size() ? never : graph.events[graph.passed].time_s;
}

}  // namespace

TemporalGraph make_temporal_graph(std::vector<std::vector<Hiding>> adjacency) {
    using Kind = TemporalGraph::Event::Kind;
    TemporalGraph graph;
    graph.active.resize(adjacency.size());
    for (Index from = 0; from < adjacency.size(); ++from) {
        for (const Hiding& edge : adjacency[from]) {
            const TemporalGraph::Event begins{edge.when.begin_s, from, edge.to, Kind::begins};
            if (edge.when.begin_s == -never)
                set_active(graph, begins, Kind::begins);
            else
                graph.events.push_back(begins);
            if (edge.when.end_s != never)
                graph.events.push_back({edge.when.end_s, from, edge.to, Kind::ends});
        }
    }
    std::stable_sort(graph.events.begin(), graph.events.end(),
                     [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
    graph.adjacency = std::move(adjacency);
    graph.levels = sort_by_levels(graph.active);
    graph.order = front_to_back(graph.levels);
    set_bounds(graph);
    return graph;
}

std::vector<std::vector<Hiding>> find_adjacencies(std::span<const SpacetimeExtent> extents,
                                                  const SpacetimeExtent& viewpoints, const TimeTree& times) {
    std::vector<std::vector<Hiding>> adjacency(extents.size());
    for (Index from = 0; from < extents.size(); ++from)
        for (Index to = 0; to < extents.size(); ++to)
            if (from != to)
                for (const TimeSpan& span : hiding_spans(extents[from], extents[to], viewpoints, times))
                    adjacency[from].push_back({to, span});
    return adjacency;
}

GraphWork update(TemporalGraph& graph, double time_s) {
    GraphWork work;
    std::vector<Index> heads;
    const auto pass = [&](const TemporalGraph::Event& event, TemporalGraph::Event::Kind kind) {
        set_active(graph, event, kind);
        heads.push_back(event.to);
        ++work.events;
    };
    while (graph.passed < graph.events.size() && graph.events[graph.passed].time_s <= time_s) {
        pass(graph.events[graph.passed], graph.events[graph.passed].kind);
        ++graph.passed;
    }
    while (graph.passed > 0 && graph.events[graph.passed - 1].time_s > time_s) {
        --graph.passed;
        pass(graph.events[graph.passed], opposite(graph.events[graph.passed].kind));
    }
    if (heads.empty()) return work;
    work.nodes_sorted = resort_by_levels(graph.levels, graph.active, heads);
    graph.order = front_to_back(graph.levels);
    set_bounds(graph);
    return work;
}

}  // namespace afterglow
