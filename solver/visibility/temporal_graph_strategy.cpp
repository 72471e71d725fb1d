#include "solver/visibility/temporal_graph_strategy.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <mutex>

#include "solver/visibility/block_lines.h"

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 4;

/// Adds up what the parts of a parallel loop have done.
class SharedWork {
  public:
    explicit SharedWork(TemporalGraphWork& sum) : sum_(sum) {}
    void add(const TemporalGraphWork& part) {
        const std::lock_guard lock(mutex_);
        sum_.add(part);
    }

  private:
    std::mutex mutex_;
    TemporalGraphWork& sum_;
};

}  // namespace

/// What all blocks of an update share.
struct TemporalGraphStrategy::Frame {
    const LineScene& scene;
    const DirectionRange& range;
    VisibleLines& visible;
    std::size_t slice;
    std::vector<Pose> poses;        // of bodies
    std::vector<Box> placed_boxes;  // of actors
};

TemporalGraphStrategy::TemporalGraphStrategy(const World& world, const FrameClock& clock,
                                             const TemporalGraphConfig& config)
    : clock_(clock),
      config_(config),
      stage_(make_actor_stage(world, config.frames_per_slice / clock.frames_per_second, 2 * lift_for(world))),
      own_(world),
      own_light_(world) {}

void TemporalGraphStrategy::learn(const LineScene& scene, const DirectionRange& range,
                                  const Context& context) {
    if (first_group_.empty()) {
        groups_ = make_view_groups(scene.mesh, scene.sight, config_.grouping);
        encounters_.resize(scene.sight.static_blocks());
        for (std::size_t b = 0, g = 0; b <= encounters_.size(); ++b) {
            while (g < groups_.size() && groups_[g].last_block <= b) ++g;
            first_group_.push_back(g);
        }
    }
    const bool lamps_wanted = !lamps_known_ && range.first == 0;
    if (range.last <= directions_ && !lamps_wanted) return;
    const EncounterScene encounters{scene.mesh,       scene.sight,    scene.light, scene.caster,
                                    scene.background, stage_.extents, stage_.times};
    extend_encounters(encounters, {directions_, range.last}, encounters_, context);
    if (lamps_wanted) find_light_encounters(encounters, encounters_, context);
    directions_ = std::max(directions_, range.last);
    lamps_known_ = lamps_known_ || lamps_wanted;
    rebuild_groups(context);
}

void TemporalGraphStrategy::rebuild_groups(const Context& context) {
    sights_.assign(groups_.size(), {});
    context.for_chunks(groups_.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g)
            sights_[g] = make_group_sight(groups_[g], stage_, encounters_);
    });
}

void TemporalGraphStrategy::update_groups(double time_s, const Context& context) {
    SharedWork shared(work_);
    context.for_chunks(groups_.size(), 16, [&](std::size_t begin, std::size_t end) {
        TemporalGraphWork work;
        for (std::size_t g = begin; g < end; ++g)
            afterglow::update(sights_[g], groups_[g], stage_, config_.search, time_s, work);
        shared.add(work);
    });
}

std::uint32_t TemporalGraphStrategy::follow_packet(const Frame& frame, std::size_t block,
                                                   const LinePacket& lines, std::span<const Encounter> actors,
                                                   std::uint32_t lanes, LaneHits& hits,
                                                   TemporalGraphWork& work) const {
    const PacketQuery query{lines, actors, frame.placed_boxes, frame.poses, config_.search};
    ++work.packets;
    // Most packets with an encounter in this slice of time miss every box at this moment.
    std::uint32_t near = 0;
    for (const Encounter& encounter : actors)
        near |= lanes_through(lines, frame.placed_boxes[encounter.actor]);
    near &= lanes;
    std::uint32_t found = 0;
    if (near == 0) return found;
    for (std::size_t g = first_group_[block]; g < groups_.size() && groups_[g].first_block <= block; ++g)
        if ((near & groups_[g].lanes) != 0)
            found |= follow(sights_[g], stage_, query, near & groups_[g].lanes, hits, work);
    return found;
}

void TemporalGraphStrategy::look(const Frame& frame, std::size_t block, TemporalGraphWork& work) const {
    const LineScene& scene = frame.scene;
    const PatchBlock& b = scene.sight.blocks()[block];
    const LineTargets& background = scene.background.background;
    const std::size_t from = scene.sight.line(b, frame.range.first, 0);
    const std::size_t to = scene.sight.line(b, frame.range.last, 0);
    std::copy(background.patch.begin() + static_cast<std::ptrdiff_t>(from),
              background.patch.begin() + static_cast<std::ptrdiff_t>(to),
              frame.visible.patch.begin() + static_cast<std::ptrdiff_t>(from));
    const BlockLines of_block(scene.sight, block, Pose{});
    LinePacket lines;
    LaneHits hits;
    for_due_packets(
        encounters_[block].sight, frame.range, frame.slice,
        [&](Index direction, std::span<const Encounter> actors) {
            const std::size_t first = scene.sight.line(b, direction, 0);
            of_block.rays(direction, lines.rays);
            std::copy_n(background.distance.begin() + static_cast<std::ptrdiff_t>(first), b.count,
                        lines.rays.far.begin());
            lines.prepare();
            hits.start(lines.rays);
            std::uint32_t found = follow_packet(frame, block, lines, actors, lines.all(), hits, work);
            for (; found != 0; found &= found - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(found));
                const Hit hit{hits.body[lane], hits.triangle[lane], hits.side[lane], hits.distance[lane]};
                frame.visible.patch[first + lane] =
                    target_of(hit, lines.rays.ray(lane), scene.mesh, scene.caster);
            }
        });
}

void TemporalGraphStrategy::look_at_lamps(const Frame& frame, std::size_t block,
                                          TemporalGraphWork& work) const {
    const LineScene& scene = frame.scene;
    const PatchBlock& b = scene.sight.blocks()[block];
    std::vector<float>& visible = frame.visible.light_contribution;
    for (Index k = 0; k < scene.light.lines_per_patch(); ++k) {
        const std::size_t first = scene.light.line(b, k, 0);
        if (scene.mesh.body[scene.light.lamp_patch(block, k)] == furniture)
            std::copy_n(scene.background.light_contribution.begin() + static_cast<std::ptrdiff_t>(first),
                        b.count, visible.begin() + static_cast<std::ptrdiff_t>(first));
    }
    LinePacket lines;
    LaneHits hits;
    std::array<float, 16> unused;
    for_due_packets(encounters_[block].light, {0, scene.light.lines_per_patch()}, frame.slice,
                    [&](Index k, std::span<const Encounter> actors) {
                        const std::size_t first = scene.light.line(b, k, 0);
                        scene.light.rays(block, k, scene.caster, lines.rays, unused);
                        lines.prepare();
                        hits.start(lines.rays);
                        std::uint32_t lit = 0;
                        for (Index lane = 0; lane < b.count; ++lane)
                            if (visible[first + lane] > 0) lit |= 1U << lane;
                        std::uint32_t found = follow_packet(frame, block, lines, actors, lit, hits, work);
                        for (; found != 0; found &= found - 1)
                            visible[first + static_cast<std::size_t>(std::countr_zero(found))] = 0;
                    });
}

std::uint64_t TemporalGraphStrategy::update(const LineScene& scene, const DirectionRange& range,
                                            VisibleLines& visible, const Context& context) {
    work_ = {};
    learn(scene, range, context);
    const double time_s = clock_.time_of(scene.frame);
    update_groups(time_s, context);

    Frame frame{scene, range, visible, stage_.times.slice_at(time_s), {Pose{}}, {}};
    for (Index actor = 0; actor < stage_.size(); ++actor) {
        frame.poses.push_back(scene.caster.pose(actor + 1));
        frame.placed_boxes.push_back(
            placed_box(stage_.bodies[actor].box, frame.poses.back(), scene.sight.lift_m()));
    }
    SharedWork shared(work_);
    context.for_chunks(encounters_.size(), blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        TemporalGraphWork work;
        for (std::size_t b = begin; b < end; ++b) {
            look(frame, b, work);
            if (range.first == 0) look_at_lamps(frame, b, work);
        }
        shared.add(work);
    });

    std::uint64_t own = own_.update(scene, range, visible, context);
    if (range.first == 0) own += own_light_.update(scene, visible, context);
    return work_.lines_searched + own;
}

std::uint64_t TemporalGraphStrategy::lines_kept(const SightLines& sight) const {
    std::uint64_t lines = 0;
    for (std::size_t b = 0; b < encounters_.size(); ++b) {
        Index last = no_index;
        for (const Encounter& e : encounters_[b].sight) {
            if (e.direction != last) lines += sight.blocks()[b].count;
            last = e.direction;
        }
    }
    return lines;
}

std::size_t TemporalGraphStrategy::graphs() const {
    return static_cast<std::size_t>(std::count_if(
        sights_.begin(), sights_.end(), [](const GroupSight& sight) { return !sight.actors.empty(); }));
}

std::unique_ptr<VisibilityStrategy> make_temporal_graph(const World& world, const FrameClock& clock) {
    if (!anything_moves(world)) return make_back_buffer(world, clock);
    return std::make_unique<TemporalGraphStrategy>(world, clock);
}

}  // namespace afterglow
