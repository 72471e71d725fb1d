#include "solver/visibility/strategy.h"

namespace afterglow {

namespace {

class Retrace : public VisibilityStrategy {
  public:
    [[nodiscard]] bool needs_background() const override { return false; }

    std::uint64_t update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                         const Context& context) override {
        const LineRange lines{0, scene.sight.blocks().size(), range.first, range.last};
        std::uint64_t rays = trace_lines(scene.sight, scene.mesh, scene.caster, Scope::everything, lines,
                                         LineSinks{visible.patch, {}}, context);
        if (range.first == 0)
            rays += trace_light_lines(scene.light, scene.sight, scene.caster, Scope::everything,
                                      visible.light_contribution, context);
        return rays;
    }
};

}  // namespace

std::optional<double> VisibilityStrategy::follow_path(const LineScene&, Index, const Path&, const Context&) {
    return std::nullopt;
}

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

}  // namespace afterglow
