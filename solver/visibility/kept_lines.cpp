#include "solver/visibility/kept_lines.h"

#include <algorithm>
#include <atomic>

#include "solver/visibility/block_lines.h"
#include "solver/visibility/line_tests.h"

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 4;

/// Lines are named by block, direction and lane, so a block's keep their place only if it has as many
/// patches.
bool is_block_kept(const PatchBlock& block, Index patches_before) {
    return block.first < patches_before && std::min(block_size, patches_before - block.first) == block.count;
}

class Retracer {
  public:
    Retracer(const KeptFurniture& before, StaticLines& lines, const PatchMesh& mesh, const SightLines& sight,
             const LightLines& light, const RayCaster& caster)
        : before_(before), lines_(lines), mesh_(mesh), sight_(sight), light_(light), caster_(caster) {}

    std::uint64_t sight_lines(std::size_t b) {
        const PatchBlock& block = sight_.blocks()[b];
        const LineTargets& old = before_.lines.background;
        const std::uint32_t lost = lost_lanes(block);
        const BlockLines of_block(sight_, b, Pose{});
        std::uint64_t rays = 0;
        for (Index d = 0; d < sight_.lines_per_patch(); ++d) {
            const std::size_t line = sight_.line(block, d, 0);
            of_block.rays(d, packet_.rays);
            std::uint32_t stale = lost;
            for (Index lane = 0; lane < block.count; ++lane) {
                if (((stale >> lane) & 1U) != 0) continue;
                if (!is_kept(old.patch[line + lane])) stale |= 1U << lane;
                packet_.rays.far[lane] = old.distance[line + lane];
            }
            if (stale != all(block)) stale |= crossing();
            if (stale == 0) {
                copy(old.patch, line, block.count, lines_.background.patch);
                copy(old.distance, line, block.count, lines_.background.distance);
                continue;
            }
            rays += trace(of_block, d, line);
        }
        return rays;
    }

    std::uint64_t light_lines(std::size_t b) {
        const PatchBlock& block = sight_.blocks()[b];
        const std::uint32_t lost = before_.same_lamps ? lost_lanes(block) : all(block);
        std::array<float, 16> contribution;
        std::uint64_t rays = 0;
        for (Index k = 0; k < light_.lines_per_patch(); ++k) {
            const std::size_t line = light_.line(block, k, 0);
            light_.rays(b, k, caster_, packet_.rays, contribution);
            std::uint32_t stale = lost;
            if (stale != all(block)) stale |= crossing();
            if (stale == 0)
                copy(before_.lines.light_contribution, line, block.count, lines_.light_contribution);
            else
                rays += trace_light(contribution, line);
        }
        return rays;
    }

  private:
    static std::uint32_t all(const PatchBlock& block) { return (1U << block.count) - 1U; }

    /// Bits of the lanes whose patches are new.
    [[nodiscard]] std::uint32_t lost_lanes(const PatchBlock& block) const {
        if (!is_block_kept(block, before_.patches)) return all(block);
        std::uint32_t lost = 0;
        for (Index lane = 0; lane < block.count; ++lane)
            if (before_.kept[block.first + lane] == 0) lost |= 1U << lane;
        return lost;
    }

    /// Whether what a line saw is certainly still there to be seen. What sees_inside met is not known.
    [[nodiscard]] bool is_kept(Index target) const {
        if (target == sees_nothing) return true;
        return target < before_.kept.size() && before_.kept[target] != 0;
    }

    /// Bits of the lanes that meet a changed place before their far end.
    std::uint32_t crossing() {
        packet_.prepare();
        std::uint32_t lanes = 0;
        for (const Box& box : before_.changed) lanes |= lanes_through(packet_, box);
        return lanes;
    }

    template <class T>
    static void copy(const std::vector<T>& from, std::size_t first, Index count, std::vector<T>& to) {
        std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(first), count,
                    to.begin() + static_cast<std::ptrdiff_t>(first));
    }

    std::uint64_t trace(const BlockLines& of_block, Index direction, std::size_t line) {
        of_block.rays(direction, packet_.rays);
        HitPacket hits;
        caster_.nearest(packet_.rays, Scope::static_geometry, hits);
        for (Index lane = 0; lane < packet_.rays.count; ++lane) {
            lines_.background.patch[line + lane] = target_of(hits[lane], packet_.rays.ray(lane), mesh_);
            lines_.background.distance[line + lane] = hits[lane].distance;
        }
        return packet_.rays.count;
    }

    std::uint64_t trace_light(const std::array<float, 16>& contribution, std::size_t line) {
        std::uint64_t rays = 0;
        for (Index lane = 0; lane < packet_.rays.count; ++lane) {
            if (contribution[lane] > 0)
                ++rays;
            else
                packet_.rays.far[lane] = 0;
        }
        const std::uint32_t blocked = rays == 0 ? 0 : caster_.occluded(packet_.rays, Scope::static_geometry);
        for (Index lane = 0; lane < packet_.rays.count; ++lane)
            lines_.light_contribution[line + lane] = ((blocked >> lane) & 1U) != 0 ? 0 : contribution[lane];
        return rays;
    }

    const KeptFurniture& before_;
    StaticLines& lines_;
    const PatchMesh& mesh_;
    const SightLines& sight_;
    const LightLines& light_;
    const RayCaster& caster_;
    LinePacket packet_;
};

}  // namespace

std::uint64_t retrace_changed_lines(const KeptFurniture& before, StaticLines& lines, const PatchMesh& mesh,
                                    const SightLines& sight, const LightLines& light, const RayCaster& caster,
                                    const Context& context) {
    lines = make_static_lines(mesh, sight, light);
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(sight.static_blocks(), blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        Retracer retracer(before, lines, mesh, sight, light, caster);
        std::uint64_t rays = 0;
        for (std::size_t b = begin; b < end; ++b) rays += retracer.sight_lines(b) + retracer.light_lines(b);
        traced += rays;
    });
    lines.directions = sight.lines_per_patch();
    return traced;
}

}  // namespace afterglow
