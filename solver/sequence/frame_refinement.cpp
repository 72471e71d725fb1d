#include "solver/sequence/frame_refinement.h"

#include "solver/formfactor/outside_light.h"
#include "solver/radiosity/ambient.h"
#include "solver/sequence/prepare.h"
#include "solver/sequence/stopwatch.h"

namespace afterglow {

namespace {

int samples_of(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return 1;
        case Quality::preview:
            return 4;
        case Quality::final:
            return 16;
    }
    return 1;
}

}  // namespace

FrameRefinement::FrameRefinement(SequenceState::Parts& parts, double time_s)
    : parts_(parts), time_s_(time_s) {
    parts.caster.set_poses(poses_at(parts.world, time_s));
    for (Index m = 0; m < parts.world.materials.size(); ++m)
        materials_.push_back(material_at(parts.world, m, time_s));
    const PatchMesh& mesh = parts.mesh;
    for (Index p = 0; p < mesh.size(); ++p) {
        const Material& material = materials_[mesh.material(p)];
        const bool shines = mesh.side[p] == Side::front || material.shines == Material::Shines::both;
        emission_.push_back(shines ? pi * material.emission : Rgb(0));
        reflectance_.push_back(material.reflectance * mesh.texture_mean[p]);
    }
}

void FrameRefinement::look(Index directions, VisibilityStrategy& strategy, const Context& context) {
    if (directions <= directions_) return;
    std::uint64_t static_rays = 0;
    if (strategy.needs_background())
        static_rays = advance_static_pass(parts_, directions, context.part(0, 0.4));
    const Stopwatch watch;
    context.report(0.4, "looking along the sight lines");
    statistics_.rays_traced +=
        static_rays + strategy.update(parts_.lines(), {directions_, directions}, parts_.visible, context);
    directions_ = directions;
    statistics_.visibility += watch.elapsed();
    compile(context);
}

void FrameRefinement::compile(const Context& context) {
    const Stopwatch watch;
    const SeenLines seen{parts_.visible.patch, directions_, parts_.visible.light_contribution};
    factors_ =
        compile_rows(parts_.mesh, *parts_.sight, *parts_.light, parts_.lamps, parts_.caster, seen, context);
    columns_ = columns_of(factors_.matrix, context);
    outside_ = outside_irradiance(parts_.world, time_s_, parts_.mesh, *parts_.sight, parts_.caster, factors_,
                                  statistics_.rays_traced, context);
    statistics_.visibility += watch.elapsed();
}

RadiosityProblem FrameRefinement::problem() const {
    return {factors_.matrix, parts_.mesh.area_m2, emission_, reflectance_, outside_};
}

void FrameRefinement::solve(double asked_error, const Context& context) {
    const Stopwatch watch;
    context.report(0.6, "solving the light");
    ProgressiveConfig config;
    config.asked_error = asked_error;
    // Cold every time: the same light whatever was solved for a preliminary picture before.
    light_ = make_progressive_state(problem(), context);
    do {
        certificate_ = step(*light_, problem(), columns_, config, context.part(0.6, 0.8));
    } while (light_->status == ProgressiveStatus::running);
    statistics_.shots += light_->shots;
    statistics_.residual = certificate_.residual;
    statistics_.error_bound = certificate_.error_bound;
    statistics_.active_patches = parts_.mesh.size();
    statistics_.solve += watch.elapsed();
}

Picture FrameRefinement::picture(int width, int height, int samples, std::span<const Rgb> irradiance,
                                 const Context& context) {
    const Stopwatch watch;
    context.report(0.8, "rendering the picture");
    const LitWorld lit{&parts_.world, &parts_.mesh, &*parts_.interpolation, &parts_.caster,
                       materials_,    irradiance,   factors_.valid_share};
    const CameraView view = view_at(parts_.camera, time_s_, width, height);
    Picture made = render_picture(view, lit, {samples, parts_.config.seed}, statistics_.rays_traced, context);
    statistics_.image += watch.elapsed();
    return made;
}

Picture FrameRefinement::preliminary_picture(int width, int height, const Context& context) {
    return picture(width, height, 1, irradiance_with_ambient(problem(), *light_), context);
}

Picture FrameRefinement::final_picture(const Context& context) {
    return picture(parts_.config.width, parts_.config.height, samples_of(parts_.config.quality),
                   light_->irradiance, context);
}

}  // namespace afterglow
