#include "solver/visibility/group_sight.h"

#include <algorithm>
#include <bit>

#include "solver/visibility/tie.h"

namespace afterglow {

namespace {

/// Runs of set slices as spans of time.
std::vector<TimeSpan> spans_of(const std::vector<char>& slices, const TimeTree& times) {
    std::vector<TimeSpan> spans;
    for (std::size_t k = 0; k < slices.size(); ++k) {
        if (slices[k] == 0) continue;
        if (k > 0 && slices[k - 1] != 0)
            spans.back().end_s = times.slice(k).end_s;
        else
            spans.push_back(times.slice(k));
    }
    return spans;
}

void mark(std::vector<std::vector<char>>& slices, std::span<const Encounter> encounters) {
    for (const Encounter& e : encounters)
        std::fill(slices[e.actor].begin() + e.first_slice, slices[e.actor].begin() + e.last_slice + 1, 1);
}

std::uint32_t search_body(const SearchedBody& body, const TemporalBsp& tree, const PacketQuery& query,
                          std::uint32_t lanes, LaneHits& hits, SearchWork& work) {
    LinePacket local;
    to_body(query.lines.rays, query.poses[body.body], local);
    switch (query.search) {
        case FaceSearch::all:
            return search_all(body, local.rays, lanes, hits, work);
        case FaceSearch::order:
            return search_in_order(body, tree, local.rays, lanes, hits, work);
        case FaceSearch::tree:
            break;
    }
    return search_tree(body, tree, local, lanes, hits, work);
}

/// A body's faces for lanes that may have met other actors before; of those in a tie the lower number stays.
std::uint32_t search_among(const SearchedBody& body, const TemporalBsp& tree, const PacketQuery& query,
                           std::uint32_t lanes, LaneHits& hits, SearchWork& work) {
    const std::array<float, 16> met = hits.distance;
    for (std::size_t lane = 0; lane < 16; ++lane)
        if (hits.body[lane] != no_index)
            hits.distance[lane] = hits.body[lane] < body.body ? before_tie(met[lane]) : after_tie(met[lane]);
    const std::uint32_t found = search_body(body, tree, query, lanes, hits, work);
    for (std::size_t lane = 0; lane < 16; ++lane)
        if (((found >> lane) & 1U) == 0) hits.distance[lane] = met[lane];
    return found;
}

}  // namespace

ActorStage make_actor_stage(const World& world, double slice_s, float slack_m) {
    ActorStage stage;
    for (Index b = 1; b < world.bodies.size(); ++b) stage.paths.push_back(world.bodies[b].path);
    stage.times = make_time_tree(stage.paths, slice_s);
    for (Index b = 1; b < world.bodies.size(); ++b) {
        stage.bodies.push_back(make_searched_body(world, b));
        stage.extents.push_back(
            swept_extent(stage.bodies.back().box, world.bodies[b].path, stage.times, slack_m));
        stage.views.push_back(steady_views(world.bodies[b].path, Path{}));
    }
    return stage;
}

bool GroupSight::present(Index node) const {
    // The background is the last of all nodes, so it stands last among the successors.
    const std::vector<Index>& successors = graph.active[node];
    return !successors.empty() && successors.back() == background();
}

bool GroupSight::any_present() const {
    for (Index node = 0; node < background(); ++node)
        if (present(node)) return true;
    return false;
}

GroupSight make_group_sight(const ViewGroup& group, const ActorStage& stage,
                            std::span<const BlockEncounters> encounters) {
    std::vector<std::vector<char>> slices(stage.size(), std::vector<char>(stage.times.slices(), 0));
    for (std::size_t b = group.first_block; b < group.last_block; ++b) {
        mark(slices, encounters[b].sight);
        mark(slices, encounters[b].light);
    }
    GroupSight sight;
    std::vector<SpacetimeExtent> extents;
    for (Index actor = 0; actor < stage.size(); ++actor) {
        if (std::find(slices[actor].begin(), slices[actor].end(), 1) == slices[actor].end()) continue;
        sight.actors.push_back(actor);
        extents.push_back(stage.extents[actor]);
    }
    if (sight.actors.empty()) return sight;
    auto adjacency = find_adjacencies(extents, resting_extent(group.origins), stage.times);
    for (Index node = 0; node < sight.background(); ++node)
        for (const TimeSpan& span : spans_of(slices[sight.actors[node]], stage.times))
            adjacency[node].push_back({sight.background(), span});
    adjacency.emplace_back();
    sight.graph = make_temporal_graph(std::move(adjacency));
    sight.trees.resize(sight.actors.size());
    return sight;
}

void TemporalGraphWork::add(const TemporalGraphWork& other) {
    graph_updates += other.graph_updates;
    graph_events += other.graph_events;
    nodes_sorted += other.nodes_sorted;
    tree_visits += other.tree_visits;
    side_changes += other.side_changes;
    packets += other.packets;
    lines_searched += other.lines_searched;
    search.line_face_tests += other.search.line_face_tests;
    search.node_visits += other.search.node_visits;
}

void update(GroupSight& sight, const ViewGroup& group, const ActorStage& stage, FaceSearch search,
            double time_s, TemporalGraphWork& work) {
    if (sight.actors.empty()) return;
    const GraphWork done = update(sight.graph, time_s);
    work.graph_updates += done.events > 0 ? 1U : 0U;
    work.graph_events += done.events;
    work.nodes_sorted += done.nodes_sorted;
    if (search == FaceSearch::all) return;
    for (Index node = 0; node < sight.background(); ++node) {
        if (!sight.present(node)) continue;
        const Index actor = sight.actors[node];
        const BspTree& tree = stage.bodies[actor].tree;
        if (sight.trees[node].nodes.empty()) {
            sight.trees[node] = make_temporal_bsp(tree, stage.views[actor], group.viewpoint, time_s);
            work.tree_visits += tree.nodes.size();
            continue;
        }
        const TreeWork visited = update(sight.trees[node], tree, stage.views[actor], group.viewpoint, time_s);
        work.tree_visits += visited.nodes_visited;
        work.side_changes += visited.sides_changed;
    }
}

std::uint32_t follow(const GroupSight& sight, const ActorStage& stage, const PacketQuery& query,
                     std::uint32_t lanes, LaneHits& hits, TemporalGraphWork& work) {
    work.lines_searched += static_cast<std::uint64_t>(std::popcount(lanes));
    std::uint32_t found = 0, looking = lanes;
    Index component = no_index;
    for (const Index node : sight.graph.order) {
        if (node == sight.background()) break;
        if (sight.graph.levels.component[node] != component) {
            component = sight.graph.levels.component[node];
            looking = lanes & ~found;
            if (looking == 0) break;
        }
        const Index actor = sight.actors[node];
        const auto comes_between = [actor](const Encounter& e) { return e.actor == actor; };
        if (std::none_of(query.actors.begin(), query.actors.end(), comes_between)) continue;
        const std::uint32_t near = looking & lanes_through(query.lines, query.placed_boxes[actor]);
        if (near == 0) continue;
        found |= search_among(stage.bodies[actor], sight.trees[node], query, near, hits, work.search);
    }
    return found;
}

}  // namespace afterglow
