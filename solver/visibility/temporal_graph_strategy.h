#pragma once

#include "solver/visibility/group_sight.h"
#include "solver/visibility/own_light_lines.h"
#include "solver/visibility/own_lines.h"
#include "solver/visibility/strategy.h"

namespace afterglow {

struct TemporalGraphConfig {
    /// Which patches share a graph: see the table in this room's README.
    Grouping grouping = Grouping::block;
    FaceSearch search = FaceSearch::tree;
    /// How finely extents and intervals follow time.
    double frames_per_slice = 4;
};

/// The report's own visibility. Static lines keep their backgrounds. Those that no actor's spacetime extent
/// ever cuts are definitely valid and dropped; the others are followed front to back through their group's
/// temporal graph, whose last node is the background.
/// The same lines, mesh and world must be given to every update. Source: Tost and Pueyo 1993, section 3.
class TemporalGraphStrategy final : public VisibilityStrategy {
  public:
    /// Keeps copies of what it needs of the world. `clock` tells what LineScene::frame means.
    TemporalGraphStrategy(const World& world, const FrameClock& clock,
                          const TemporalGraphConfig& config = {});

    [[nodiscard]] bool needs_background() const override { return true; }
    std::uint64_t update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                         const Context& context) override;

    /// What the last update has done.
    [[nodiscard]] const TemporalGraphWork& work() const { return work_; }
    /// Sight lines in packets that some actor may cut at some time, of those looked at so far.
    [[nodiscard]] std::uint64_t lines_kept(const SightLines& sight) const;
    /// Graphs that are kept: groups that are not definitely valid.
    [[nodiscard]] std::size_t graphs() const;

  private:
    struct Frame;
    void learn(const LineScene& scene, const DirectionRange& range, const Context& context);
    void rebuild_groups(const Context& context);
    void update_groups(double time_s, const Context& context);
    void look(const Frame& frame, std::size_t block, TemporalGraphWork& work) const;
    void look_at_lamps(const Frame& frame, std::size_t block, TemporalGraphWork& work) const;
    std::uint32_t follow_packet(const Frame& frame, std::size_t block, const LinePacket& lines,
                                std::span<const Encounter> actors, std::uint32_t lanes, LaneHits& hits,
                                TemporalGraphWork& work) const;

    FrameClock clock_;
    TemporalGraphConfig config_;
    ActorStage stage_;
    Index directions_ = 0;  // known of every block
    bool lamps_known_ = false;
    std::vector<BlockEncounters> encounters_;  // by static block
    std::vector<ViewGroup> groups_;
    std::vector<std::size_t> first_group_;  // by static block, and one more
    std::vector<GroupSight> sights_;        // by group
    TemporalGraphWork work_;
    OwnLines own_;
    OwnLightLines own_light_;
};

}  // namespace afterglow
