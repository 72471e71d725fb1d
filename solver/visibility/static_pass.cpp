#include "solver/visibility/static_pass.h"

namespace afterglow {

StaticLines make_static_lines(const PatchMesh& mesh, const SightLines& sight, const LightLines& light) {
    StaticLines lines;
    const std::size_t count = std::size_t{mesh.static_size()} * sight.lines_per_patch();
    lines.background.patch.assign(count, sees_nothing);
    lines.background.distance.assign(count, 0);
    lines.light_contribution.assign(std::size_t{mesh.static_size()} * light.lines_per_patch(), 0);
    return lines;
}

std::uint64_t extend_static_lines(StaticLines& lines, const PatchMesh& mesh, const SightLines& sight,
                                  const LightLines& light, const RayCaster& caster, Index directions,
                                  const Context& context) {
    if (directions <= lines.directions) return 0;
    std::uint64_t rays = 0;
    if (lines.directions == 0)
        rays += trace_light_lines(light, sight, caster, Scope::static_geometry, lines.light_contribution,
                                  context);
    const LineRange range{0, sight.static_blocks(), lines.directions, directions};
    rays += trace_lines(sight, mesh, caster, Scope::static_geometry, range,
                        {lines.background.patch, lines.background.distance}, context);
    lines.directions = directions;
    return rays;
}

}  // namespace afterglow
