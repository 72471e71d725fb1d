#pragma once

#include "solver/base/context.h"
#include "solver/mesh/patch_mesh.h"
#include "solver/visibility/ray_caster.h"

namespace afterglow {

struct ReachConfig {
    float spacing_m = 0.2F;    ///< about one sample origin for each square of this edge
    int rays_per_origin = 16;  ///< directions from each origin
    int max_origins = 256;     ///< a surface side
    std::uint64_t seed = 1;    ///< of the directions
};

/// Which sides of which surfaces light can reach or leave: those connected by sight lines, directly or over
/// other sides, to a light, the sky or a camera. The outside of a closed room and the inside of a table leg
/// are not among them, and a model of the light there is not needed. Sides of one component are found by
/// joining the two ends of sampled lines (a line serves both ways); actors count at the poses of their knots
/// and between. Thread-safety: places the caster's actors; no other use of it at the same time.
SideMask reachable_sides(const World& world, const Surfaces& surfaces, RayCaster& caster,
                         const ReachConfig& config, const Context& context);

}  // namespace afterglow
