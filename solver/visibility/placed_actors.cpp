#include "solver/visibility/placed_actors.h"

#include <algorithm>
#include <bit>

#include "solver/mesh/lift.h"
#include "solver/visibility/sight_lines.h"
#include "solver/visibility/spacetime_extent.h"
#include "solver/visibility/tie.h"

namespace afterglow {

namespace {

/// The lines in a body's frame; those not among `lanes` end where they start and are not traced.
LinePacket in_body(const LinePacket& lines, std::uint32_t lanes, const Pose& pose) {
    LinePacket local;
    to_body(lines.rays, pose, local);
    for (std::size_t lane = 0; lane < lines.rays.count; ++lane)
        if (((lanes >> lane) & 1U) == 0) local.rays.far[lane] = 0;
    return local;
}

}  // namespace

// Lines may be off by rounding, less than they are lifted off surfaces for it.
PlacedActors::PlacedActors(const World& world)
    : boxes_(world.bodies.size()), moved_(world.bodies.size(), 0), slack_m_(2 * lift_for(world)) {
    for (Index b = 0; b < world.bodies.size(); ++b) {
        Box& box = local_boxes_.emplace_back();
        if (b == furniture) continue;
        for (const Vec3& position : world.bodies[b].positions) box.add(position);
    }
}

void PlacedActors::place(const RayCaster& caster) {
    const bool first = poses_.empty();
    if (first) poses_.resize(local_boxes_.size());
    for (Index b = 1; b < bodies(); ++b) {
        const Pose& pose = caster.pose(b);
        moved_[b] = first || pose != poses_[b] ? 1 : 0;
        if (moved_[b] == 0) continue;
        poses_[b] = pose;
        boxes_[b] = placed_box(local_boxes_[b], pose, slack_m_);
    }
}

bool PlacedActors::any_moved() const {
    return std::find(moved_.begin(), moved_.end(), 1) != moved_.end();
}

std::uint32_t PlacedActors::look(LinePacket& lines, Index body, const PatchMesh& mesh,
                                 const RayCaster& caster, Index* target) const {
    const std::uint32_t near = lanes_through(lines, boxes_[body]);
    if (near == 0) return 0;
    const LinePacket local = in_body(lines, near, poses_[body]);
    HitPacket hits;
    caster.nearest(local.rays, body, hits);
    for (std::uint32_t left = near; left != 0; left &= left - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(left));
        if (hits[lane].body == no_index) continue;
        lines.rays.far[lane] = before_tie(hits[lane].distance);
        target[lane] = target_of(hits[lane], local.rays.ray(lane), mesh);
    }
    return near;
}

PlacedActors::Hidden PlacedActors::hide(const LinePacket& lines, std::uint32_t open, Index body,
                                        const RayCaster& caster) const {
    const std::uint32_t near = open & lanes_through(lines, boxes_[body]);
    if (near == 0) return {};
    return {near, near & caster.occluded(in_body(lines, near, poses_[body]).rays, body)};
}

}  // namespace afterglow
