#include "tests/support/solved_world.h"

#include <algorithm>
#include <cmath>

#include "solver/visibility/events.h"
#include "solver/visibility/reach.h"

namespace afterglow::testing {

namespace {

PatchMesh mesh_reached(const World& world, RayCaster& caster, float size) {
    Surfaces surfaces = find_surfaces(world, {.facet_size_m = size});
    ReachConfig reach;
    reach.spacing_m = size;
    const SideMask reached = reachable_sides(world, surfaces, caster, reach, Context(1));
    return make_patches(world, std::move(surfaces), reached, {.patch_size_m = size});
}

// Frames so fine that every time a test looks at is one.
constexpr FrameClock fine_clock{1000};

std::unique_ptr<VisibilityStrategy> make_strategy(Visibility visibility, const World& world) {
    switch (visibility) {
        case Visibility::retrace:
            return make_retrace();
        case Visibility::back_buffer:
            return make_back_buffer(world, fine_clock);
        case Visibility::temporal_graph:
            return make_temporal_graph(world, fine_clock);
        case Visibility::events:
            return make_events(world, fine_clock, {1});
        case Visibility::automatic:
            break;  // a world to test names its strategy
    }
    return nullptr;
}

}  // namespace

std::string test_name(Visibility visibility) {
    std::string name(name_of(visibility));
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

SolvedWorld::SolvedWorld(World w, const SolvedWorldConfig& c)
    : config(c),
      world(std::move(w)),
      caster(world),
      mesh(mesh_reached(world, caster, c.patch_size_m)),
      lamps(find_lamps(world, mesh)),
      sight(mesh, world, c.lines, c.seed),
      light(mesh, sight, lamps, c.light_lines, mixed(c.seed)),
      visible(make_visible_lines(mesh, sight, light)),
      background_(make_static_lines(mesh, sight, light)),
      strategy_(make_strategy(c.visibility, world)) {
    if (strategy_->needs_background())
        extend_static_lines(background_, mesh, sight, light, caster, c.lines, Context(1));
}

void SolvedWorld::look(double time_s) {
    const Context context(1);
    caster.set_poses(poses_at(world, time_s));
    const int frame = static_cast<int>(std::lround(time_s * fine_clock.frames_per_second));
    strategy_->update({mesh, sight, light, caster, background_, frame}, {0, config.lines}, visible, context);
    factors = compile_rows(mesh, sight, light, lamps, caster,
                           {visible.patch, config.lines, visible.light_contribution}, context);
    lights = lights_at(world, time_s);
    materials.clear();
    emission.clear();
    reflectance.clear();
    for (Index m = 0; m < world.materials.size(); ++m) materials.push_back(material_at(world, m, time_s));
    for (Index p = 0; p < mesh.size(); ++p) {
        const Material& material = materials[mesh.material(p)];
        emission.push_back(is_emitter(world, mesh, p) ? pi * material.emission : Rgb(0));
        reflectance.push_back(material.reflectance * mesh.texture_mean[p]);
    }
}

void SolvedWorld::solve(double time_s) {
    look(time_s);
    const Context context(1);
    std::uint64_t rays = 0;
    from_lights = light_irradiance(lights, mesh, sight, caster, factors.valid_share, rays, context);
    external = sky_irradiance(world, factors.sky);
    for (std::size_t p = 0; p < external.size(); ++p) external[p] += from_lights[p];
    ProgressiveConfig progressive;
    progressive.asked_error = config.asked_error;
    solution = solve_progressive(problem(), columns_of(factors.matrix, context), progressive, context);
}

RadiosityProblem SolvedWorld::problem() const {
    return {factors.matrix, mesh.area_m2, emission, reflectance, external};
}

Rgb SolvedWorld::radiosity(Index patch) const {
    return emission[patch] + reflectance[patch] * solution.state.irradiance[patch];
}

double SolvedWorld::factor_to_surface(Index patch, Index surface) const {
    double sum = 0;
    const FormFactorMatrix& matrix = factors.matrix;
    for (auto e = matrix.row_begin[patch]; e < matrix.row_begin[patch + 1]; ++e)
        if (mesh.surface[matrix.column[e]] == surface) sum += static_cast<double>(matrix.value[e]);
    return sum;
}

std::vector<Index> SolvedWorld::patches_of(Index surface, Side side) const {
    std::vector<Index> out;
    for (Index p = 0; p < mesh.size(); ++p)
        if (mesh.surface[p] == surface && mesh.side[p] == side) out.push_back(p);
    return out;
}

}  // namespace afterglow::testing
