#include "solver/visibility/encounters.h"

#include <algorithm>

#include "solver/visibility/block_lines.h"

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 4;

/// The first and the last slice in which some line meets the extent.
void widen(const LinePacket& lines, const SpacetimeExtent& extent, const TimeTree& times, std::size_t node,
           Encounter& encounter) {
    const std::size_t slices = times.slices();
    // The slices of this node: those between its leftmost and rightmost descendants.
    std::size_t first = node, last = node;
    while (first < slices) {
        first = 2 * first;
        last = 2 * last + 1;
    }
    if (first - slices >= encounter.first_slice && last - slices <= encounter.last_slice) return;
    if (lanes_through(lines, extent.at(node)) == 0) return;
    if (node < slices && extent.box.size() > 1) {
        widen(lines, extent, times, 2 * node, encounter);
        widen(lines, extent, times, 2 * node + 1, encounter);
        return;
    }
    encounter.first_slice =
        static_cast<std::uint16_t>(std::min<std::size_t>(encounter.first_slice, first - slices));
    encounter.last_slice =
        static_cast<std::uint16_t>(std::max<std::size_t>(encounter.last_slice, last - slices));
}

void add_encounters(const LinePacket& lines, Index direction, std::span<const SpacetimeExtent> actors,
                    const TimeTree& times, std::vector<Encounter>& out) {
    constexpr std::uint16_t none = 0xFFFF;
    for (Index actor = 0; actor < actors.size(); ++actor) {
        Encounter encounter{direction, actor, none, 0};
        widen(lines, actors[actor], times, 1, encounter);
        if (encounter.first_slice != none) out.push_back(encounter);
    }
}

}  // namespace

void find_encounters(const SightLines& sight, std::size_t block, const LineTargets& background,
                     const DirectionRange& range, std::span<const SpacetimeExtent> actors,
                     const TimeTree& times, std::vector<Encounter>& out) {
    const BlockLines of_block(sight, block, Pose{});
    LinePacket lines;
    const PatchBlock& b = sight.blocks()[block];
    for (Index d = range.first; d < range.last; ++d) {
        of_block.rays(d, lines.rays);
        std::copy_n(background.distance.begin() + static_cast<std::ptrdiff_t>(sight.line(b, d, 0)), b.count,
                    lines.rays.far.begin());
        lines.prepare();
        add_encounters(lines, d, actors, times, out);
    }
}

void find_light_encounters(const LightLines& light, const SightLines& sight, const PatchMesh& mesh,
                           std::size_t block, const RayCaster& placed, const std::vector<float>& unblocked,
                           std::span<const SpacetimeExtent> actors, const TimeTree& times,
                           std::vector<Encounter>& out) {
    LinePacket lines;
    std::array<float, 16> contribution;
    const PatchBlock& b = sight.blocks()[block];
    for (Index k = 0; k < light.lines_per_patch(); ++k) {
        if (mesh.body[light.lamp_patch(block, k)] != furniture) continue;
        light.rays(block, k, placed, lines.rays, contribution);
        for (Index lane = 0; lane < b.count; ++lane)
            if (unblocked[light.line(b, k, lane)] == 0) lines.rays.far[lane] = -1;
        lines.prepare();
        add_encounters(lines, k, actors, times, out);
    }
}

void extend_encounters(const EncounterScene& scene, const DirectionRange& range,
                       std::vector<BlockEncounters>& encounters, const Context& context) {
    encounters.resize(scene.sight.static_blocks());
    if (scene.actors.empty() || range.first >= range.last) return;
    context.for_chunks(encounters.size(), blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            std::vector<Encounter>& known = encounters[b].sight;
            while (!known.empty() && known.back().direction >= range.first) known.pop_back();
            find_encounters(scene.sight, b, scene.background.background, range, scene.actors, scene.times,
                            known);
        }
    });
}

void find_light_encounters(const EncounterScene& scene, std::vector<BlockEncounters>& encounters,
                           const Context& context) {
    encounters.resize(scene.sight.static_blocks());
    if (scene.actors.empty()) return;
    context.for_chunks(encounters.size(), blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            encounters[b].light.clear();
            find_light_encounters(scene.light, scene.sight, scene.mesh, b, scene.placed,
                                  scene.background.light_contribution, scene.actors, scene.times,
                                  encounters[b].light);
        }
    });
}

}  // namespace afterglow
