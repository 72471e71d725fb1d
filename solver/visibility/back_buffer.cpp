#include "solver/visibility/back_buffer.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <utility>

#include "solver/visibility/block_lines.h"

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 4;
// How finely swept volumes follow time.
constexpr double frames_per_slice = 4;

Box box_of(const Body& body) {
    Box box;
    for (const Vec3& position : body.positions) box.add(position);
    return box;
}

}  // namespace

BackBuffer::BackBuffer(const World& world, const FrameClock& clock)
    : clock_(clock), actors_(world), own_(world), own_light_(world) {
    std::vector<Path> paths;
    for (std::size_t b = 1; b < world.bodies.size(); ++b) paths.push_back(world.bodies[b].path);
    times_ = make_time_tree(paths, frames_per_slice / clock.frames_per_second);
    for (std::size_t b = 1; b < world.bodies.size(); ++b)
        extents_.push_back(swept_extent(box_of(world.bodies[b]), paths[b - 1], times_, 2 * lift_for(world)));
}

std::uint64_t BackBuffer::update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                                 const Context& context) {
    actors_.place(scene.caster);
    if (actors_.any_moved()) shown_ = 0;
    std::uint64_t rays = own_.update(scene, range, visible, context);
    if (range.first == 0) rays += own_light_.update(scene, visible, context);
    if (range.last <= shown_) return rays;
    looked_ = true;

    find_encounters(scene, range, context);
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(encounters_.size(), blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t b = begin; b < end; ++b) {
            count += look(scene, b, range, visible);
            if (range.first == 0) count += look_at_lamps(scene, b, visible);
        }
        traced += count;
    });
    if (range.first <= shown_) shown_ = range.last;
    return rays + traced;
}

std::optional<LineChanges> BackBuffer::take_changes() {
    if (std::exchange(looked_, false)) return std::nullopt;
    return LineChanges{};
}

void BackBuffer::find_encounters(const LineScene& scene, const DirectionRange& range,
                                 const Context& context) {
    const EncounterScene encounters{scene.mesh,       scene.sight, scene.light, scene.caster,
                                    scene.background, extents_,    times_};
    extend_encounters(encounters, {directions_, range.last}, encounters_, context);
    directions_ = std::max(directions_, range.last);
    if (lamps_known_ || range.first > 0) return;
    find_light_encounters(encounters, encounters_, context);
    lamps_known_ = true;
}

std::uint64_t BackBuffer::look(const LineScene& scene, std::size_t block, const DirectionRange& range,
                               VisibleLines& visible) const {
    const PatchBlock& b = scene.sight.blocks()[block];
    const LineTargets& background = scene.background.background;
    const auto from = static_cast<std::ptrdiff_t>(scene.sight.line(b, range.first, 0));
    const auto to = static_cast<std::ptrdiff_t>(scene.sight.line(b, range.last, 0));
    std::copy(background.patch.begin() + from, background.patch.begin() + to, visible.patch.begin() + from);
    std::uint64_t traced = 0;
    const BlockLines of_block(scene.sight, block, Pose{});
    LinePacket lines;
    for_due_packets(
        encounters_[block].sight, range, times_.slice_at(clock_.time_of(scene.frame)),
        [&](Index direction, std::span<const Encounter> due) {
            const std::size_t first = scene.sight.line(b, direction, 0);
            of_block.rays(direction, lines.rays);
            std::copy_n(background.distance.begin() + static_cast<std::ptrdiff_t>(first), b.count,
                        lines.rays.far.begin());
            lines.prepare();
            for (const Encounter& encounter : due)
                traced += static_cast<std::uint64_t>(std::popcount(actors_.look(
                    lines, encounter.actor + 1, scene.mesh, scene.caster, &visible.patch[first])));
        });
    return traced;
}

std::uint64_t BackBuffer::look_at_lamps(const LineScene& scene, std::size_t block,
                                        VisibleLines& visible) const {
    const PatchBlock& b = scene.sight.blocks()[block];
    const std::vector<float>& open = scene.background.light_contribution;
    for (Index k = 0; k < scene.light.lines_per_patch(); ++k) {
        if (scene.mesh.body[scene.light.lamp_patch(block, k)] != furniture) continue;
        const auto first = static_cast<std::ptrdiff_t>(scene.light.line(b, k, 0));
        std::copy_n(open.begin() + first, b.count, visible.light_contribution.begin() + first);
    }
    std::uint64_t traced = 0;
    LinePacket lines;
    std::array<float, 16> unused;
    for_due_packets(
        encounters_[block].light, {0, scene.light.lines_per_patch()},
        times_.slice_at(clock_.time_of(scene.frame)), [&](Index k, std::span<const Encounter> due) {
            float* const result = &visible.light_contribution[scene.light.line(b, k, 0)];
            scene.light.rays(block, k, scene.caster, lines.rays, unused);
            lines.prepare();
            std::uint32_t lit = 0;
            for (std::size_t lane = 0; lane < b.count; ++lane)
                if (result[lane] > 0) lit |= 1U << lane;
            for (const Encounter& encounter : due) {
                const auto [met, hidden] = actors_.hide(lines, lit, encounter.actor + 1, scene.caster);
                traced += static_cast<std::uint64_t>(std::popcount(met));
                lit &= ~hidden;
            }
            for (std::size_t lane = 0; lane < b.count; ++lane)
                if (((lit >> lane) & 1U) == 0) result[lane] = 0;
        });
    return traced;
}

std::unique_ptr<VisibilityStrategy> make_back_buffer(const World& world, const FrameClock& clock) {
    return std::make_unique<BackBuffer>(world, clock);
}

}  // namespace afterglow
