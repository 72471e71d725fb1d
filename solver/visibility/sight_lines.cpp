#include "solver/visibility/sight_lines.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "solver/visibility/block_lines.h"

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 4;

}  // namespace

Index different_moving_lines(Index lines_per_patch, const MovingLinesConfig& moving) {
    for (Index repeats = moving.repeats; repeats > 1; --repeats)
        if (lines_per_patch % repeats == 0 && lines_per_patch / repeats >= moving.fewest)
            return lines_per_patch / repeats;
    return lines_per_patch;
}

SightLines::SightLines(const PatchMesh& mesh, const World& world, Index lines_per_patch, std::uint64_t seed,
                       const MovingLinesConfig& moving)
    : mesh_(&mesh),
      lines_per_patch_(lines_per_patch),
      moving_lines_(different_moving_lines(lines_per_patch, moving)),
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
    BlockLines(*this, block, pose).rays(direction, out);
}

Sample4 SightLines::sample(std::size_t block, Index direction) const {
    return points_.at(direction % different_lines(blocks_[block]), mixed(seed_, block));
}

namespace {

Index target_at(const Hit& hit, const Vec3& at, const Vec3& direction, const PatchMesh& mesh) {
    if (mesh.slipped(mesh.surfaces.of_triangle[hit.body][hit.triangle], hit.side, at, direction))
        return sees_inside;
    const Index patch = mesh.patch_at(hit.body, hit.triangle, hit.side, at);
    return patch == no_index ? sees_inside : patch;
}

}  // namespace

Index target_of(const Hit& hit, const Ray& ray, const PatchMesh& mesh) {
    if (hit.body == no_index) return sees_nothing;
    return target_at(hit, ray.origin + hit.distance * ray.direction, ray.direction, mesh);
}

Index target_of(const Hit& hit, const Ray& ray, const PatchMesh& mesh, const RayCaster& caster) {
    if (hit.body == no_index || hit.body == furniture) return target_of(hit, ray, mesh);
    const Pose& pose = caster.pose(hit.body);
    const Quat back = glm::conjugate(pose.rotation);
    const Vec3 at = ray.origin + hit.distance * ray.direction;
    return target_at(hit, back * (at - pose.translation), back * ray.direction, mesh);
}

namespace {

/// What a packet's lines see. Neighbours mostly see one side of one surface.
void targets_of(const HitPacket& hits, const RayPacket& rays, const PatchMesh& mesh, const RayCaster& caster,
                std::span<Index> out) {
    alignas(64) std::array<float, 16> x, y, z;
    for (std::size_t k = 0; k < 16; ++k) {
        const float distance = k < rays.count ? hits[k].distance : 0;
        x[k] = rays.origin_x[k] + distance * rays.direction_x[k];
        y[k] = rays.origin_y[k] + distance * rays.direction_y[k];
        z[k] = rays.origin_z[k] + distance * rays.direction_z[k];
    }
    Index surface = no_index;
    Side side = Side::front;
    const CellTree* tree = nullptr;
    const SurfaceGrid* grid = nullptr;
    for (std::size_t k = 0; k < out.size(); ++k) {
        const Hit& hit = hits[k];
        if (hit.body != furniture) {
            out[k] = target_of(hit, rays.ray(k), mesh, caster);
            continue;
        }
        const Index s = mesh.surfaces.of_triangle[furniture][hit.triangle];
        if (s != surface || hit.side != side) {
            surface = s;
            side = hit.side;
            tree = &mesh.trees[s][static_cast<std::size_t>(side)];
            grid = &mesh.grids[s];
            if (grid->cells_u == 0 || tree->empty() || !tree->dividers.empty()) tree = nullptr;
        }
        out[k] = tree == nullptr ? no_index : tree->leaf_at(grid->cell_at(Vec3(x[k], y[k], z[k]))).item;
        if (out[k] == no_index) out[k] = target_of(hit, rays.ray(k), mesh, caster);
    }
}

/// What is known of some lines goes for others, too.
void repeat(std::size_t to, std::size_t from, Index count, const LineSinks& sinks) {
    const auto copy = [&](auto values) {
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(from), count,
                    values.begin() + static_cast<std::ptrdiff_t>(to));
    };
    copy(sinks.patch);
    if (!sinks.distance.empty()) copy(sinks.distance);
}

}  // namespace

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
                const Index different = lines.different_lines(block);
                const BlockLines of_block(lines, b, caster.pose(block.body));
                for (Index d = range.first_direction; d < range.last_direction; ++d) {
                    const std::size_t first = lines.line(block, d, 0);
                    if (d >= range.first_direction + different) {
                        repeat(first, lines.line(block, d - different, 0), block.count, sinks);
                        continue;
                    }
                    of_block.rays(d, rays);
                    if (block.body == furniture || scope != Scope::everything)
                        caster.nearest(rays, scope, hits);
                    else
                        caster.nearest_from(block.body, rays, hits);
                    targets_of(hits, rays, mesh, caster, sinks.patch.subspan(first, block.count));
                    for (Index lane = 0; lane < block.count && !sinks.distance.empty(); ++lane)
                        sinks.distance[first + lane] = hits[lane].distance;
                    count += block.count;
                }
            }
            traced += count;
        });
    return traced;
}

}  // namespace afterglow
