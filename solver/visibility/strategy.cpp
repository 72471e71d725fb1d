#include "solver/visibility/strategy.h"

#include <algorithm>

namespace afterglow {

namespace {

/// Lines of the blocks from `first_block` on, against everything.
std::uint64_t trace_anew(const LineScene& scene, std::size_t first_block, const DirectionRange& range,
                         VisibleLines& visible, const Context& context) {
    const LineRange lines{first_block, scene.sight.blocks().size(), range.first, range.last};
    return trace_lines(scene.sight, scene.mesh, scene.caster, Scope::everything, lines,
                       LineSinks{visible.patch, {}}, context);
}

class Retrace : public VisibilityStrategy {
  public:
    [[nodiscard]] bool needs_background() const override { return false; }

    std::uint64_t update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                         const Context& context) override {
        std::uint64_t rays = trace_anew(scene, 0, range, visible, context);
        if (range.first == 0)
            rays += trace_light_lines(scene.light, scene.sight, scene.mesh, scene.caster, Scope::everything,
                                      visible.light_contribution, context);
        return rays;
    }
};

class BackBuffer : public VisibilityStrategy {
  public:
    [[nodiscard]] bool needs_background() const override { return true; }

    std::uint64_t update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                         const Context& context) override {
        std::uint64_t rays =
            trace_over_background(scene.sight, scene.mesh, scene.caster, scene.background.background, range,
                                  visible.patch, context);
        rays += trace_anew(scene, scene.sight.static_blocks(), range, visible, context);
        if (range.first > 0) return rays;
        std::copy(scene.background.light_contribution.begin(), scene.background.light_contribution.end(),
                  visible.light_contribution.begin());
        return rays + trace_light_lines(scene.light, scene.sight, scene.mesh, scene.caster, Scope::actors,
                                        visible.light_contribution, context);
    }
};

}  // namespace

Milliseconds total(std::span<const WorkAhead> work) {
    Milliseconds sum{};
    for (const WorkAhead& window : work) sum += window.time;
    return sum;
}

VisibleLines make_visible_lines(const PatchMesh& mesh, const SightLines& sight, const LightLines& light) {
    VisibleLines visible;
    visible.patch.assign(std::size_t{mesh.size()} * sight.lines_per_patch(), sees_nothing);
    visible.light_contribution.assign(std::size_t{mesh.size()} * light.lines_per_patch(), 0);
    return visible;
}

std::unique_ptr<VisibilityStrategy> make_retrace() {
    return std::make_unique<Retrace>();
}
std::unique_ptr<VisibilityStrategy> make_back_buffer() {
    return std::make_unique<BackBuffer>();
}

}  // namespace afterglow
