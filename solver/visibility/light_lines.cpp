#include "solver/visibility/light_lines.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace afterglow {

LightLines::LightLines(const PatchMesh& mesh, const SightLines& lines, const Lamps& lamps,
                       Index lines_per_patch, std::uint64_t seed)
    : mesh_(&mesh),
      lines_(&lines),
      lamps_(&lamps),
      lines_per_patch_(lamps.patches.empty() ? 0 : lines_per_patch),
      seed_(seed),
      points_(lines_per_patch) {}

LightLines::Choice LightLines::choose(std::size_t block, Index k) const {
    // Systematic sampling: one shift a block, then equal steps through the lamps' power.
    const float shift = static_cast<float>(mixed(seed_, block) >> 40U) * 0x1p-24F;
    const float at = (static_cast<float>(k) + shift) / static_cast<float>(lines_per_patch_);
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
    const Sample4 sample = points_.at(k, mixed(seed_, block + 1));
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

/// How one sample of a block is traced.
enum class Trace {
    nothing,          ///< not at all: what is known stands
    static_geometry,  ///< against the furniture
    everything,       ///< against furniture and actors
    over_background,  ///< against the actors only, where the furniture leaves it open
};

/// Traces the samples of blocks [0, blocks) as `how(block, lamp patch)` says.
template <class How>
std::uint64_t trace_samples(const LightLines& light_lines, const SightLines& lines, const RayCaster& caster,
                            std::size_t blocks, std::vector<float>& unblocked, const Context& context,
                            const How& how) {
    std::atomic<std::uint64_t> traced = 0;
    const Index per_patch = light_lines.lines_per_patch();
    context.for_chunks(per_patch > 0 ? blocks : 0, 4, [&](std::size_t begin, std::size_t end) {
        RayPacket rays;
        std::array<float, 16> contribution;
        std::uint64_t count = 0;
        for (std::size_t b = begin; b < end; ++b) {
            const PatchBlock& block = lines.blocks()[b];
            for (Index k = 0; k < per_patch; ++k) {
                const Trace trace = how(block, light_lines.lamp_patch(b, k));
                if (trace == Trace::nothing) continue;
                light_lines.rays(b, k, caster, rays, contribution);
                float* const result = &unblocked[light_lines.line(block, k, 0)];
                if (trace == Trace::over_background) std::copy_n(result, block.count, contribution.begin());
                const Index alive = switch_off_dark(rays, contribution);
                const Scope against = trace == Trace::static_geometry   ? Scope::static_geometry
                                      : trace == Trace::over_background ? Scope::actors
                                                                        : Scope::everything;
                const std::uint32_t blocked = alive == 0 ? 0 : caster.occluded(rays, against);
                for (Index lane = 0; lane < block.count; ++lane)
                    result[lane] = ((blocked >> lane) & 1U) != 0 ? 0.0F : contribution[lane];
                count += alive;
            }
        }
        traced += count;
    });
    return traced;
}

}  // namespace

std::uint64_t trace_light_lines(const LightLines& light_lines, const SightLines& lines, const PatchMesh& mesh,
                                const RayCaster& caster, Scope scope, std::vector<float>& unblocked,
                                const Context& context) {
    const bool static_only = scope == Scope::static_geometry;
    return trace_samples(
        light_lines, lines, caster, static_only ? lines.static_blocks() : lines.blocks().size(), unblocked,
        context, [&](const PatchBlock& block, Index lamp) {
            if (static_only) return Trace::static_geometry;
            const bool known = block.body == furniture && mesh.body[lamp] == furniture;
            return scope == Scope::actors && known ? Trace::over_background : Trace::everything;
        });
}

std::uint64_t trace_moving_light_lines(const LightLines& light_lines, const SightLines& lines,
                                       const PatchMesh& mesh, const RayCaster& caster,
                                       std::vector<float>& unblocked, const Context& context) {
    return trace_samples(light_lines, lines, caster, lines.blocks().size(), unblocked, context,
                         [&](const PatchBlock& block, Index lamp) {
                             return block.body == furniture && mesh.body[lamp] == furniture
                                        ? Trace::nothing
                                        : Trace::everything;
                         });
}

}  // namespace afterglow
