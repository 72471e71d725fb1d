#include "solver/visibility/lines_alone.h"

#include <algorithm>

#include "solver/visibility/block_lines.h"

namespace afterglow {

void LinesAlone::reserve(const SightLines& sight, const PatchMesh& mesh) {
    if (!known_.empty()) return;
    known_.resize(sight.blocks().size() - sight.static_blocks());
    lines_.patch.resize(index(sight, mesh, {mesh.size(), 0, 1}, 0));
    lines_.distance.resize(lines_.patch.size());
}

std::uint64_t LinesAlone::extend(const SightLines& sight, const PatchMesh& mesh, const RayCaster& caster,
                                 std::size_t block, Index last) {
    const PatchBlock& b = sight.blocks()[block];
    Index& known = known_[block - sight.static_blocks()];
    const BlockLines of_block(sight, block, Pose{});
    std::uint64_t traced = 0;
    RayPacket rays;
    HitPacket hits;
    for (; known < std::min(last, sight.different_lines(b)); ++known) {
        const std::size_t at = index(sight, mesh, b, known);
        of_block.rays(known, rays);
        caster.nearest(rays, b.body, hits);
        for (std::size_t lane = 0; lane < rays.count; ++lane) {
            lines_.patch[at + lane] = target_of(hits[lane], rays.ray(lane), mesh);
            // What touches the body there is hidden by it, however the distances of both are rounded.
            lines_.distance[at + lane] = std::max(hits[lane].distance - sight.lift_m(), 0.0F);
        }
        traced += rays.count;
    }
    return traced;
}

}  // namespace afterglow
