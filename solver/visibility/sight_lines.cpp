#include "solver/visibility/sight_lines.h"

#include <algorithm>
#include <atomic>

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 4;

}  // namespace

SightLines::SightLines(const PatchMesh& mesh, const World& world, Index lines_per_patch, std::uint64_t seed)
    : mesh_(&mesh),
      lines_per_patch_(lines_per_patch),
      seed_(seed),
      points_(lines_per_patch),
      lift_m_(lift_for(world)) {
    for (Index body = 0; body + 1 < mesh.first_patch_of_body.size(); ++body) {
        const Index last = mesh.first_patch_of_body[body + 1];
        for (Index first = mesh.first_patch_of_body[body]; first < last; first += block_size)
            blocks_.push_back({first, std::min(block_size, last - first), body});
        if (body == furniture) static_blocks_ = blocks_.size();
    }
}

std::size_t SightLines::block_of(Index patch) const {
    const auto after = std::upper_bound(blocks_.begin(), blocks_.end(), patch,
                                        [](Index p, const PatchBlock& block) { return p < block.first; });
    return static_cast<std::size_t>(after - blocks_.begin()) - 1;
}

void SightLines::rays(std::size_t block, Index direction, const Pose& pose, RayPacket& out) const {
    const PatchBlock& b = blocks_[block];
    const Sample4 sample = points_.at(direction, mixed(seed_, block));
    const Vec3 local = cosine_direction(sample[0], sample[1]);
    out.count = b.count;
    for (Index lane = 0; lane < b.count; ++lane) {
        const PatchPoint point = mesh_->point_on(b.first + lane, sample[2], sample[3]);
        Ray ray{point.position + lift_m_ * point.normal, Frame(point.normal).to_world(local)};
        if (b.body != furniture) {
            ray.origin = pose.point(ray.origin);
            ray.direction = pose.direction(ray.direction);
        }
        out.set(lane, ray);
    }
}

Index target_of(const Hit& hit, const Ray& ray, const PatchMesh& mesh, const RayCaster& caster) {
    if (hit.body == no_index) return sees_nothing;
    Vec3 at = ray.origin + hit.distance * ray.direction, direction = ray.direction;
    if (hit.body != furniture) {
        const Pose& pose = caster.pose(hit.body);
        const Quat back = glm::conjugate(pose.rotation);
        at = back * (at - pose.translation);
        direction = back * direction;
    }
    if (mesh.slipped(mesh.surfaces.of_triangle[hit.body][hit.triangle], hit.side, at, direction))
        return sees_inside;
    const Index patch = mesh.patch_at(hit.body, hit.triangle, hit.side, at);
    return patch == no_index ? sees_inside : patch;
}

std::uint64_t trace_lines(const SightLines& lines, const PatchMesh& mesh, const RayCaster& caster,
                          Scope scope, const LineRange& range, const LineSinks& sinks,
                          const Context& context) {
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(
        range.last_block - range.first_block, blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
            RayPacket rays;
            HitPacket hits;
            std::uint64_t count = 0;
            for (std::size_t b = range.first_block + begin; b < range.first_block + end; ++b) {
                const PatchBlock& block = lines.blocks()[b];
                for (Index d = range.first_direction; d < range.last_direction; ++d) {
                    lines.rays(b, d, caster.pose(block.body), rays);
                    caster.nearest(rays, scope, hits);
                    const std::size_t first = lines.line(block, d, 0);
                    for (Index lane = 0; lane < block.count; ++lane) {
                        sinks.patch[first + lane] = target_of(hits[lane], rays.ray(lane), mesh, caster);
                        if (!sinks.distance.empty()) sinks.distance[first + lane] = hits[lane].distance;
                    }
                    count += block.count;
                }
            }
            traced += count;
        });
    return traced;
}

std::uint64_t trace_over_background(const SightLines& lines, const PatchMesh& mesh, const RayCaster& caster,
                                    const LineTargets& background, const DirectionRange& range,
                                    std::span<Index> visible, const Context& context) {
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(lines.static_blocks(), blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        RayPacket rays;
        HitPacket hits;
        std::uint64_t count = 0;
        for (std::size_t b = begin; b < end; ++b) {
            const PatchBlock& block = lines.blocks()[b];
            for (Index d = range.first; d < range.last; ++d) {
                lines.rays(b, d, Pose{}, rays);
                const std::size_t first = lines.line(block, d, 0);
                std::copy_n(background.distance.begin() + static_cast<std::ptrdiff_t>(first), block.count,
                            rays.far.begin());
                caster.nearest(rays, Scope::actors, hits);
                for (Index lane = 0; lane < block.count; ++lane)
                    visible[first + lane] = hits[lane].body == no_index
                                                ? background.patch[first + lane]
                                                : target_of(hits[lane], rays.ray(lane), mesh, caster);
                count += block.count;
            }
        }
        traced += count;
    });
    return traced;
}

}  // namespace afterglow
