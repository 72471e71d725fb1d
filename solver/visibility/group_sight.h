#pragma once

#include <vector>

#include "solver/visibility/encounters.h"
#include "solver/visibility/face_search.h"
#include "solver/visibility/temporal_graph.h"
#include "solver/visibility/view_groups.h"

namespace afterglow {

/// How an actor's faces are searched, see face_search.
enum class FaceSearch {
    all,    ///< object level: any order, nearest hit
    order,  ///< surface level: in the temporal BSP tree's order, first hit
    tree,   ///< surface level: walking the tree
};

/// What is known of the actors for all times and all viewpoints. Actor k is body k + 1.
struct ActorStage {
    TimeTree times;
    std::vector<SpacetimeExtent> extents;
    std::vector<SearchedBody> bodies;
    std::vector<std::vector<SteadyView>> views;  ///< from whoever stands still in the world
    std::vector<Path> paths;

    [[nodiscard]] Index size() const { return static_cast<Index>(bodies.size()); }
};

/// `slice_s`: how finely the extents follow time; `slack_m`: how far lines may be off by rounding. Errors:
/// none. Thread-safety: pure.
ActorStage make_actor_stage(const World& world, double slice_s, float slack_m);

/// What a group of viewpoints knows: which actors ever come between its lines and their backgrounds, their
/// graph of depth priority, and their trees. The graph's last node is the background.
struct GroupSight {
    std::vector<Index> actors;  ///< by node of the graph, rising; empty: the group is definitely valid
    TemporalGraph graph;
    std::vector<TemporalBsp> trees;  ///< by node; made when an actor is first present

    [[nodiscard]] Index background() const { return static_cast<Index>(actors.size()); }
    /// Whether the actor of a node may hide any of the group's backgrounds now.
    [[nodiscard]] bool present(Index node) const;
    [[nodiscard]] bool any_present() const;
};

/// The graph of a group from its blocks' encounters.
GroupSight make_group_sight(const ViewGroup& group, const ActorStage& stage,
                            std::span<const BlockEncounters> encounters);

/// What has been done, in counts.
struct TemporalGraphWork {
    std::uint64_t graph_updates = 0;   ///< graphs in which an adjacency came or went
    std::uint64_t graph_events = 0;    ///< adjacencies that came or went
    std::uint64_t nodes_sorted = 0;    ///< objects sorted anew by level
    std::uint64_t tree_visits = 0;     ///< nodes of temporal BSP trees whose change had come
    std::uint64_t side_changes = 0;    ///< nodes whose sign changed
    std::uint64_t packets = 0;         ///< packets of lines made, since some actor may come between
    std::uint64_t lines_searched = 0;  ///< lines followed through their graph
    SearchWork search;

    void add(const TemporalGraphWork& other);
};

/// Brings a group's graph and, where faces are to be sorted, the trees of those present to a time.
void update(GroupSight& sight, const ViewGroup& group, const ActorStage& stage, FaceSearch search,
            double time_s, TemporalGraphWork& work);

/// A packet on its way front to back.
struct PacketQuery {
    const LinePacket& lines;            ///< world coordinates, reaching to their backgrounds
    std::span<const Encounter> actors;  ///< who may come between
    std::span<const Box> placed_boxes;  ///< of the actors now, world coordinates
    std::span<const Pose> poses;        ///< of the bodies now
    FaceSearch search;
};

/// The first thing before the background that each of `lanes` meets: components of the graph front to back,
/// a line ends in the first component that it meets; within a circle the nearest hit of all its members
/// counts. Returns the lanes that met anything.
std::uint32_t follow(const GroupSight& sight, const ActorStage& stage, const PacketQuery& query,
                     std::uint32_t lanes, LaneHits& hits, TemporalGraphWork& work);

}  // namespace afterglow
