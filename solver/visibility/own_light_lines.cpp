#include "solver/visibility/own_light_lines.h"

#include <algorithm>
#include <atomic>
#include <bit>

namespace afterglow {

std::uint64_t OwnLightLines::update(const LineScene& scene, VisibleLines& visible, const Context& context) {
    if (scene.light.lines_per_patch() == 0) return 0;
    if (has_lamp_.empty()) begin(scene);
    forget_what_moved(scene);
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(known_.size(), 1, [&](std::size_t begin, std::size_t end) {
        std::uint64_t rays = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t block = first_block_ + i;
            const PatchBlock& b = scene.sight.blocks()[block];
            for (Index k = 0; k < scene.light.lines_per_patch(); ++k) {
                if (b.body == furniture && scene.mesh.body[scene.light.lamp_patch(block, k)] == furniture)
                    continue;
                const Index same = scene.light.first_same(b, k);
                if (known_[i] != Known::all && same == k)
                    rays += learn(scene, block, k, known_[i] == Known::background);
                const auto from = static_cast<std::ptrdiff_t>(scene.light.line(b, same, 0) - first_line_);
                std::copy_n(all_.begin() + from, b.count,
                            visible.light_contribution.begin() +
                                static_cast<std::ptrdiff_t>(scene.light.line(b, k, 0)));
            }
            known_[i] = Known::all;
        }
        traced += rays;
    });
    return traced;
}

void OwnLightLines::begin(const LineScene& scene) {
    has_lamp_.assign(actors_.bodies(), 0);
    bool lamps_move = false;
    for (std::size_t block = 0; block < scene.sight.blocks().size(); ++block) {
        for (Index k = 0; k < scene.light.lines_per_patch(); ++k) {
            const Index body = scene.mesh.body[scene.light.lamp_patch(block, k)];
            has_lamp_[body] = 1;
            lamps_move = lamps_move || body != furniture;
        }
    }
    const auto& blocks = scene.sight.blocks();
    first_block_ = lamps_move ? 0 : scene.sight.static_blocks();
    first_line_ = first_block_ < blocks.size() ? scene.light.line(blocks[first_block_], 0, 0) : 0;
    known_.assign(blocks.size() - first_block_, Known::nothing);
    const std::size_t lines = std::size_t{scene.mesh.size()} * scene.light.lines_per_patch();
    const std::size_t kept = known_.empty() ? 0 : lines - first_line_;
    background_.resize(kept);
    all_.resize(kept);
}

void OwnLightLines::forget_what_moved(const LineScene& scene) {
    actors_.place(scene.caster);
    if (!actors_.any_moved()) return;
    bool lamp_moved = false;
    for (Index body = 1; body < actors_.bodies(); ++body)
        lamp_moved = lamp_moved || (actors_.moved(body) && has_lamp_[body] != 0);
    for (std::size_t i = 0; i < known_.size(); ++i) {
        const Index body = scene.sight.blocks()[first_block_ + i].body;
        const bool ends_moved = lamp_moved || actors_.moved(body);
        known_[i] = ends_moved || known_[i] == Known::nothing ? Known::nothing : Known::background;
    }
}

std::uint64_t OwnLightLines::learn(const LineScene& scene, std::size_t block, Index k,
                                   bool background_is_known) {
    const PatchBlock& b = scene.sight.blocks()[block];
    const Index lamp_body = scene.mesh.body[scene.light.lamp_patch(block, k)];
    const std::size_t at = scene.light.line(b, k, 0) - first_line_;
    LinePacket lines;
    std::array<float, 16> contribution;
    scene.light.rays(block, k, scene.caster, lines.rays, contribution);
    if (background_is_known)
        std::copy_n(background_.begin() + static_cast<std::ptrdiff_t>(at), b.count, contribution.begin());
    std::uint32_t open = 0;
    for (std::size_t lane = 0; lane < b.count; ++lane) {
        // A ray that ends where it starts is not traced.
        if (contribution[lane] > 0)
            open |= 1U << lane;
        else
            lines.rays.far[lane] = 0;
    }
    std::uint64_t rays = 0;
    if (open != 0) lines.prepare();
    const auto hide_behind = [&](bool ends) {
        for (Index body = 1; body < actors_.bodies() && open != 0; ++body) {
            if ((body == b.body || body == lamp_body) != ends) continue;
            const auto [traced, hidden] = actors_.hide(lines, open, body, scene.caster);
            rays += static_cast<std::uint64_t>(std::popcount(traced));
            open &= ~hidden;
        }
    };
    const auto write = [&](std::vector<float>& out) {
        for (std::size_t lane = 0; lane < b.count; ++lane)
            out[at + lane] = ((open >> lane) & 1U) != 0 ? contribution[lane] : 0.0F;
    };
    if (!background_is_known) {
        if (open != 0) {
            rays += static_cast<std::uint64_t>(std::popcount(open));
            open &= ~scene.caster.occluded(lines.rays, furniture);
        }
        hide_behind(true);
        write(background_);
    }
    hide_behind(false);
    write(all_);
    return rays;
}

}  // namespace afterglow
