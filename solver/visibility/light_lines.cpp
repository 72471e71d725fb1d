#include "solver/visibility/light_lines.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace afterglow {

LightLines::LightLines(const PatchMesh& mesh, const SightLines& lines, const Lamps& lamps,
                       Index lines_per_patch, std::uint64_t seed, const MovingLinesConfig& moving)
    : mesh_(&mesh),
      lines_(&lines),
      lamps_(&lamps),
      lines_per_patch_(lamps.patches.empty() ? 0 : lines_per_patch),
      seed_(seed),
      points_(lines_per_patch) {
    if (lines_per_patch_ > 0) repeats_ = lines_per_patch_ / different_moving_lines(lines_per_patch_, moving);
}

LightLines::Choice LightLines::choose(std::size_t block, Index k) const {
    // Systematic sampling: one shift a block, then equal steps through the lamps' power.
    const float shift = static_cast<float>(mixed(seed_, block) >> 40U) * 0x1p-24F;
    const Index repeats = lines_->blocks()[block].body == furniture ? 1 : repeats_;
    const Index sample = k / repeats;
    const float at = (static_cast<float>(sample) + shift) * static_cast<float>(repeats) /
                     static_cast<float>(lines_per_patch_);
    const auto& cumulative = lamps_->cumulative_power;
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end() - 1, at);
    const auto entry = static_cast<std::size_t>(found - cumulative.begin());
    return {lamps_->patches[entry], cumulative[entry] - (entry > 0 ? cumulative[entry - 1] : 0.0F)};
}

Index LightLines::lamp_patch(std::size_t block, Index k) const {
    return choose(block, k).patch;
}

void LightLines::rays(std::size_t block, Index k, const RayCaster& placed, RayPacket& out,
                      std::array<float, 16>& contribution) const {
    const PatchBlock& b = lines_->blocks()[block];
    const Choice choice = choose(block, k);
    const Index repeats = b.body == furniture ? 1 : repeats_;
    const Sample4 sample = points_.at(k / repeats, mixed(seed_, block + 1));
    const Pose& lamp_pose = placed.pose(mesh_->body[choice.patch]);
    PatchPoint lamp = mesh_->point_on(choice.patch, sample[0], sample[1]);
    lamp = {lamp_pose.point(lamp.position), lamp_pose.direction(lamp.normal)};
    lamp.position += lines_->lift_m() * lamp.normal;
    const float scale =
        mesh_->area_m2[choice.patch] / (pi * static_cast<float>(lines_per_patch_) * choice.probability);

    const Pose& pose = placed.pose(b.body);
    out.count = b.count;
    for (Index lane = 0; lane < b.count; ++lane) {
        PatchPoint point = mesh_->point_on(b.first + lane, sample[2], sample[3]);
        if (b.body != furniture) point = {pose.point(point.position), pose.direction(point.normal)};
        point.position += lines_->lift_m() * point.normal;
        const Vec3 across = lamp.position - point.position;
        const float distance = glm::length(across);
        const Vec3 direction = distance > 0 ? across / distance : point.normal;
        const float cosines = std::max(0.0F, glm::dot(direction, point.normal)) *
                              std::max(0.0F, -glm::dot(direction, lamp.normal));
        contribution[lane] = distance > 0 ? scale * cosines / (distance * distance) : 0.0F;
        out.set(lane, {point.position, direction, distance});
    }
}

namespace {

constexpr std::size_t blocks_per_chunk = 4;

/// Zero contributions need no tracing: a lane is switched off by ending its ray where it starts.
Index switch_off_dark(RayPacket& rays, const std::array<float, 16>& contribution) {
    Index alive = 0;
    for (std::size_t lane = 0; lane < rays.count; ++lane) {
        if (contribution[lane] > 0)
            ++alive;
        else
            rays.far[lane] = 0;
    }
    return alive;
}

/// Traces the samples of one block. Returns the number of rays.
std::uint64_t trace_block(const LightLines& light_lines, const SightLines& lines, const RayCaster& caster,
                          Scope scope, std::size_t b, std::vector<float>& unblocked) {
    RayPacket rays;
    std::array<float, 16> contribution;
    std::uint64_t count = 0;
    const PatchBlock& block = lines.blocks()[b];
    for (Index k = 0; k < light_lines.lines_per_patch(); ++k) {
        float* const result = &unblocked[light_lines.line(block, k, 0)];
        const Index same = light_lines.first_same(block, k);
        if (same != k) {
            std::copy_n(&unblocked[light_lines.line(block, same, 0)], block.count, result);
            continue;
        }
        light_lines.rays(b, k, caster, rays, contribution);
        const Index alive = switch_off_dark(rays, contribution);
        const std::uint32_t blocked = alive == 0 ? 0 : caster.occluded(rays, scope);
        for (Index lane = 0; lane < block.count; ++lane)
            result[lane] = ((blocked >> lane) & 1U) != 0 ? 0.0F : contribution[lane];
        count += alive;
    }
    return count;
}

}  // namespace

std::uint64_t trace_light_lines(const LightLines& light_lines, const SightLines& lines,
                                const RayCaster& caster, Scope scope, std::vector<float>& unblocked,
                                const Context& context) {
    if (light_lines.lines_per_patch() == 0) return 0;
    const std::size_t blocks =
        scope == Scope::static_geometry ? lines.static_blocks() : lines.blocks().size();
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(blocks, blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t b = begin; b < end; ++b)
            count += trace_block(light_lines, lines, caster, scope, b, unblocked);
        traced += count;
    });
    return traced;
}

}  // namespace afterglow
