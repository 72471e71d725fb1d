#include "solver/visibility/coarseness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

float edge_of(const PatchShape& part) {
    return std::max(glm::length(part.edge_u), glm::length(part.edge_v));
}

/// Whether an actor comes so near to a part that it can make it too coarse.
bool is_near(const PassingActor& actor, const PatchShape& part, float size_per_distance) {
    const Vec3 at = glm::conjugate(actor.pose.rotation) * (part.centre - actor.pose.translation);
    const float away = glm::length(at - glm::clamp(at, actor.bounds.low, actor.bounds.high));
    return away < edge_of(part) * (1 + 1 / size_per_distance);
}

}  // namespace

std::vector<PassingActor> passing_actors(const World& world, int moments) {
    std::vector<PassingActor> passing;
    for (Index b = 1; b < world.bodies.size(); ++b) {
        Box bounds;
        for (const Vec3& p : world.bodies[b].positions) bounds.add(p);
        const int count = world.bodies[b].path.moves() ? std::max(moments, 2) : 1;
        for (int k = 0; k < count; ++k) {
            const double share = count > 1 ? static_cast<double>(k) / (count - 1) : 0;
            passing.push_back({b, world.bodies[b].path.at(share * world.duration_s), bounds});
        }
    }
    return passing;
}

Coarseness::Coarseness(const RayCaster& placed, const Surfaces& surfaces, const SideMask& reached,
                       float lift_m, const CoarsenessConfig& config, std::vector<PassingActor> passing)
    : placed_(&placed),
      surfaces_(&surfaces),
      reached_(&reached),
      lift_m_(lift_m),
      config_(config),
      points_(static_cast<std::size_t>(config.rays)),
      passing_(std::move(passing)) {}

bool Coarseness::operator()(const PatchShape& part, Index body, Side side) const {
    const Seen seen = look_from(part, body, side);
    if (is_uneven(seen, edge_of(part))) return true;
    if (body != furniture) return false;
    return std::any_of(passing_.begin(), passing_.end(), [&](const PassingActor& actor) {
        if (!is_near(actor, part, config_.size_per_distance)) return false;
        Seen with_actor = seen;
        look_again(actor, with_actor);
        return is_uneven(with_actor, edge_of(part));
    });
}

Coarseness::Seen Coarseness::look_from(const PatchShape& part, Index body, Side side) const {
    const float sign = side == Side::front ? 1.0F : -1.0F;
    const Scope scope = body == furniture ? Scope::static_geometry : Scope::everything;
    const Pose pose = body == furniture ? Pose{} : placed_->pose(body);
    const std::uint64_t seed = seed_of(part, config_.seed);
    const auto rays = static_cast<std::size_t>(config_.rays);
    Seen seen{std::vector<Ray>(rays), std::vector<float>(rays, std::numeric_limits<float>::infinity()),
              std::vector<char>(rays, 0)};
    for (std::size_t k = 0; k < rays; ++k) {
        const Sample4 sample = points_.at(k, seed);
        PatchPoint at = part.point_on(sample[2], sample[3]);
        at = {pose.point(at.position), pose.direction(sign * at.normal)};
        seen.rays[k] = {at.position + lift_m_ * at.normal,
                        Frame(at.normal).to_world(cosine_direction(sample[0], sample[1]))};
        note(placed_->nearest(seen.rays[k], scope), k, seen);
    }
    return seen;
}

void Coarseness::look_again(const PassingActor& actor, Seen& seen) const {
    const Quat back = glm::conjugate(actor.pose.rotation);
    for (std::size_t first = 0; first < seen.rays.size(); first += block_size) {
        RayPacket packet;
        packet.count = static_cast<Index>(std::min<std::size_t>(block_size, seen.rays.size() - first));
        for (std::size_t lane = 0; lane < packet.count; ++lane) {
            const Ray& ray = seen.rays[first + lane];
            packet.set(lane, {back * (ray.origin - actor.pose.translation), back * ray.direction,
                              seen.distance_m[first + lane]});
        }
        HitPacket hits;
        placed_->nearest(packet, actor.body, hits);
        for (std::size_t lane = 0; lane < packet.count; ++lane) note(hits[lane], first + lane, seen);
    }
}

void Coarseness::note(const Hit& hit, std::size_t ray, Seen& seen) const {
    if (hit.body == no_index) return;
    const Index surface = surfaces_->of_triangle[hit.body][hit.triangle];
    seen.distance_m[ray] = hit.distance;
    seen.is_buried[ray] = (*reached_)[surface][static_cast<std::size_t>(hit.side)] ? 0 : 1;
}

bool Coarseness::is_uneven(const Seen& seen, float edge_m) const {
    const auto buried = std::count(seen.is_buried.begin(), seen.is_buried.end(), 1);
    const auto rays = static_cast<std::ptrdiff_t>(seen.rays.size());
    if (buried > 0) return buried < rays;  // light ends within it; all buried, there is none
    double sum = 0;
    for (const float distance : seen.distance_m) {
        const float share = edge_m / std::max(distance, nearest_share * edge_m);
        sum += static_cast<double>(share * share);
    }
    return std::sqrt(sum / static_cast<double>(rays)) > static_cast<double>(config_.size_per_distance);
}

}  // namespace afterglow
