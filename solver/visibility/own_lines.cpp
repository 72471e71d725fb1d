#include "solver/visibility/own_lines.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "solver/visibility/block_lines.h"

namespace afterglow {

std::uint64_t OwnLines::update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                               const Context& context) {
    const std::size_t first = scene.sight.static_blocks(), blocks = scene.sight.blocks().size() - first;
    if (blocks == 0) return 0;
    forget_what_moved(scene);
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(blocks, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = first + begin; b < first + end; ++b) {
            traced += learn(scene, b, range.last);
            show(scene, b, range, visible);
        }
    });
    return traced;
}

void OwnLines::forget_what_moved(const LineScene& scene) {
    const std::size_t first = scene.sight.static_blocks();
    if (known_.empty()) {
        known_.resize(scene.sight.blocks().size() - first);
        alone_.reserve(scene.sight, scene.mesh);
        background_.patch.resize(alone_.size());
        background_.distance.resize(alone_.size());
        all_.resize(alone_.size());
    }
    actors_.place(scene.caster);
    if (!actors_.any_moved()) return;
    for (std::size_t b = 0; b < known_.size(); ++b) {
        known_[b].all = 0;
        if (actors_.moved(scene.sight.blocks()[first + b].body)) known_[b].background = 0;
    }
}

std::uint64_t OwnLines::learn(const LineScene& scene, std::size_t block, Index last) {
    const PatchBlock& b = scene.sight.blocks()[block];
    Known& known = known_[block - scene.sight.static_blocks()];
    last = std::min(last, scene.sight.different_lines(b));
    std::uint64_t rays = alone_.extend(scene.sight, scene.mesh, scene.caster, block, last);
    const BlockLines of_block(scene.sight, block, scene.caster.pose(b.body));
    LinePacket lines;
    for (Index d = known.all; d < last; ++d) {
        const std::size_t at = index(scene, b, d);
        const auto offset = static_cast<std::ptrdiff_t>(at);
        of_block.rays(d, lines.rays);
        if (d >= known.background) {
            std::copy_n(alone_.lines().distance.begin() + offset, b.count, lines.rays.far.begin());
            rays += look_at_furniture(scene, lines, at);
        }
        std::copy_n(background_.patch.begin() + offset, b.count, all_.begin() + offset);
        if (actors_.bodies() == 2) continue;
        std::copy_n(background_.distance.begin() + offset, b.count, lines.rays.far.begin());
        lines.prepare();
        for (Index body = 1; body < actors_.bodies(); ++body)
            if (body != b.body)
                rays += static_cast<std::uint64_t>(
                    std::popcount(actors_.look(lines, body, scene.mesh, scene.caster, &all_[at])));
    }
    known = {std::max(known.background, last), std::max(known.all, last)};
    return rays;
}

std::uint64_t OwnLines::look_at_furniture(const LineScene& scene, const LinePacket& lines, std::size_t at) {
    HitPacket hits;
    scene.caster.nearest(lines.rays, furniture, hits);
    for (std::size_t lane = 0; lane < lines.rays.count; ++lane) {
        const bool met = hits[lane].body != no_index;
        background_.patch[at + lane] =
            met ? target_of(hits[lane], lines.rays.ray(lane), scene.mesh) : alone_.lines().patch[at + lane];
        background_.distance[at + lane] = met ? hits[lane].distance : alone_.lines().distance[at + lane];
    }
    return lines.rays.count;
}

void OwnLines::show(const LineScene& scene, std::size_t block, const DirectionRange& range,
                    VisibleLines& visible) const {
    const PatchBlock& b = scene.sight.blocks()[block];
    const Index different = scene.sight.different_lines(b);
    for (Index d = range.first; d < range.last;) {
        // Lines of neighbouring directions stand together, up to where they begin to repeat.
        const Index from = d % different, count = std::min(range.last - d, different - from);
        std::copy_n(all_.begin() + static_cast<std::ptrdiff_t>(index(scene, b, from)),
                    std::size_t{count} * b.count,
                    visible.patch.begin() + static_cast<std::ptrdiff_t>(scene.sight.line(b, d, 0)));
        d += count;
    }
}

}  // namespace afterglow
