#include "solver/visibility/block_lines.h"

#include <bit>

namespace afterglow {

BlockLines::BlockLines(const SightLines& lines, std::size_t block, const Pose& pose)
    : lines_(&lines), block_(block), patches_(lines.blocks()[block]), pose_(pose) {
    const PatchMesh& mesh = lines.mesh();
    for (Index lane = 0; lane < patches_.count; ++lane) {
        const Index patch = patches_.first + lane;
        if (!mesh.is_whole(patch)) parts_ |= 1U << lane;
        const Frame frame(mesh.normal[patch]);
        origin_.set(lane, mesh.origin[patch]);
        edge_u_.set(lane, mesh.edge_u[patch]);
        edge_v_.set(lane, mesh.edge_v[patch]);
        lift_.set(lane, lines.lift_m() * frame.z);
        frame_x_.set(lane, frame.x);
        frame_y_.set(lane, frame.y);
        normal_.set(lane, frame.z);
    }
}

void BlockLines::rays(Index direction, RayPacket& out) const {
    const Sample4 sample = lines_->sample(block_, direction);
    const Vec3 local = cosine_direction(sample[0], sample[1]);
    const float s = sample[2], t = sample[3];
    out.count = patches_.count;
    for (std::size_t k = 0; k < 16; ++k) {
        out.origin_x[k] = origin_.x[k] + s * edge_u_.x[k] + t * edge_v_.x[k] + lift_.x[k];
        out.origin_y[k] = origin_.y[k] + s * edge_u_.y[k] + t * edge_v_.y[k] + lift_.y[k];
        out.origin_z[k] = origin_.z[k] + s * edge_u_.z[k] + t * edge_v_.z[k] + lift_.z[k];
        out.direction_x[k] = local.x * frame_x_.x[k] + local.y * frame_y_.x[k] + local.z * normal_.x[k];
        out.direction_y[k] = local.x * frame_x_.y[k] + local.y * frame_y_.y[k] + local.z * normal_.y[k];
        out.direction_z[k] = local.x * frame_x_.z[k] + local.y * frame_y_.z[k] + local.z * normal_.z[k];
        out.far[k] = Ray{}.far;
    }
    for (std::uint32_t left = parts_; left != 0; left &= left - 1) {
        const auto lane = static_cast<Index>(std::countr_zero(left));
        out.set(lane, ray_of_part(lane, sample, local));
    }
    if (patches_.body == furniture) return;
    for (Index lane = 0; lane < patches_.count; ++lane) {
        const Ray ray = out.ray(lane);
        out.set(lane, {pose_.point(ray.origin), pose_.direction(ray.direction)});
    }
}

Ray BlockLines::ray_of_part(Index lane, const Sample4& sample, const Vec3& local) const {
    const PatchPoint point = lines_->mesh().point_on(patches_.first + lane, sample[2], sample[3]);
    return {point.position + lines_->lift_m() * point.normal, Frame(point.normal).to_world(local)};
}

}  // namespace afterglow
