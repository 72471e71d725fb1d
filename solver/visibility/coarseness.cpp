#include "solver/visibility/coarseness.h"

#include <algorithm>
#include <cmath>

namespace afterglow {

namespace {

// Nearer than this share of a part's edge, a hit says no more than that the part touches something.
constexpr float nearest_share = 0.125F;

/// Differs between parts and is the same for the same part.
std::uint64_t seed_of(const PatchShape& part, std::uint64_t seed) {
    std::uint64_t mix = seed;
    for (int axis = 0; axis < 3; ++axis)
        mix = mixed(mix,
                    static_cast<std::uint64_t>(std::llround(1e6 * static_cast<double>(part.centre[axis]))));
    return mix;
}

}  // namespace

Coarseness::Coarseness(const RayCaster& placed, const Surfaces& surfaces, const SideMask& reached,
                       float lift_m, const CoarsenessConfig& config)
    : placed_(&placed),
      surfaces_(&surfaces),
      reached_(&reached),
      lift_m_(lift_m),
      config_(config),
      points_(static_cast<std::size_t>(config.rays)) {}

bool Coarseness::operator()(const PatchShape& part, Index body, Side side) const {
    const float edge = std::max(glm::length(part.edge_u), glm::length(part.edge_v));
    const float sign = side == Side::front ? 1.0F : -1.0F;
    const Scope scope = body == furniture ? Scope::static_geometry : Scope::everything;
    const Pose pose = body == furniture ? Pose{} : placed_->pose(body);
    const std::uint64_t seed = seed_of(part, config_.seed);
    const auto rays = static_cast<std::size_t>(config_.rays);
    std::size_t buried = 0;
    double sum = 0;
    for (std::size_t k = 0; k < rays; ++k) {
        const Sample4 sample = points_.at(k, seed);
        PatchPoint at = part.point_on(sample[2], sample[3]);
        at = {pose.point(at.position), pose.direction(sign * at.normal)};
        const Ray ray{at.position + lift_m_ * at.normal,
                      Frame(at.normal).to_world(cosine_direction(sample[0], sample[1]))};
        const Hit hit = placed_->nearest(ray, scope);
        if (hit.body == no_index) continue;
        const Index surface = surfaces_->of_triangle[hit.body][hit.triangle];
        if (!(*reached_)[surface][static_cast<std::size_t>(hit.side)]) {
            ++buried;
            continue;
        }
        const float share = edge / std::max(hit.distance, nearest_share * edge);
        sum += static_cast<double>(share * share);
    }
    if (buried > 0) return buried < rays;  // light ends within it; all buried, there is none
    return std::sqrt(sum / static_cast<double>(rays)) > static_cast<double>(config_.size_per_distance);
}

}  // namespace afterglow
