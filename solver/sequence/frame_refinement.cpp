#include "solver/sequence/frame_refinement.h"

#include <algorithm>
#include <utility>

#include "solver/base/stopwatch.h"
#include "solver/formfactor/two_halves.h"
#include "solver/image/line_noise.h"
#include "solver/radiosity/ambient.h"
#include "solver/sequence/camera_ahead.h"
#include "solver/sequence/patch_roles.h"
#include "solver/sequence/prepare.h"
#include "solver/sequence/quality.h"

namespace afterglow {

FrameRefinement::FrameRefinement(SequenceState::Parts& parts, int frame)
    : parts_(parts), frame_(frame), time_s_(parts.time_of(frame)), lights_(lights_at(parts.world, time_s_)) {
    parts.caster.set_poses(poses_at(parts.world, time_s_));
    for (Index m = 0; m < parts.world.materials.size(); ++m)
        materials_.push_back(material_at(parts.world, m, time_s_));
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
    if (strategy.needs_background() || parts_.config.solution == Solution::residual)
        static_rays = advance_static_pass(parts_, directions, context.part(0, 0.4));
    const Stopwatch watch;
    const Milliseconds ahead_before = total(strategy.work_ahead());
    context.report(0.4, "looking along the sight lines");
    statistics_.rays_traced += static_rays + strategy.update(parts_.lines(frame_), {directions_, directions},
                                                             parts_.visible, context);
    directions_ = directions;
    statistics_.visibility += watch.elapsed() - (total(strategy.work_ahead()) - ahead_before);
}

void FrameRefinement::compile(const Context& context) {
    if (rows_ && rows_->directions == directions_) return;
    std::vector<Pose> poses = poses_at(parts_.world, time_s_);
    if (parts_.kept_rows) {
        rows_ = parts_.kept_rows->rows;
        if (rows_->directions == directions_ && rows_->poses == poses) return;
    }
    auto rows = std::make_shared<CompiledRows>();
    rows->poses = std::move(poses);
    rows->directions = directions_;
    const SeenLines seen{parts_.visible.patch, directions_, parts_.visible.light_contribution};
    rows->factors =
        compile_rows(parts_.mesh, *parts_.sight, *parts_.light, parts_.lamps, parts_.caster, seen, context);
    rows->columns = columns_of(rows->factors.matrix, context);
    rows_ = std::move(rows);
}

void FrameRefinement::light_from_outside(std::span<const float> valid_share, std::span<const float> sky,
                                         const Context& context) {
    from_lights_ = light_irradiance(lights_, parts_.mesh, *parts_.sight, parts_.caster, valid_share,
                                    statistics_.rays_traced, context);
    outside_ = sky_irradiance(parts_.world, sky);
    for (std::size_t p = 0; p < outside_.size(); ++p) outside_[p] += from_lights_[p];
}

RadiosityProblem FrameRefinement::problem() const {
    return {rows_->factors.matrix, parts_.mesh.area_m2, emission_, reflectance_, outside_};
}

void FrameRefinement::prepare_rows(const Context& context) {
    const Stopwatch watch;
    compile(context);
    light_from_outside(rows_->factors.valid_share, rows_->factors.sky, context);
    statistics_.visibility += watch.elapsed();
    context.report(0.6, "solving the light");
}

void FrameRefinement::take_rows_light(const ProgressiveState& light, std::uint64_t shots_before) {
    irradiance_ = light.irradiance;
    from_lamps_ = irradiance_from_lamps();
    valid_share_ = rows_->factors.valid_share;
    exhausted_ = light.status == ProgressiveStatus::exhausted;
    note_solution(light.shots - shots_before);
}

void FrameRefinement::solve(double asked_error, const Context& context) {
    prepare_rows(context);
    const Stopwatch watch;
    ProgressiveConfig config;
    config.asked_error = asked_error;
    // Cold every time: the same light whatever was solved for a preliminary picture before.
    light_ = make_progressive_state(problem(), context);
    do {
        certificate_ = step(*light_, problem(), rows_->columns, config, context.part(0.6, 0.8));
    } while (light_->status == ProgressiveStatus::running);
    take_rows_light(*light_, 0);
    statistics_.solve += watch.elapsed();
}

void FrameRefinement::solve_finally(double asked_error, const Context& context) {
    switch (parts_.config.solution) {
        case Solution::automatic:
        case Solution::progressive:
            return solve(asked_error, context);
        case Solution::incremental:
            return follow_changes(asked_error, context);
        case Solution::active_passive:
            return follow_active(asked_error, context);
        case Solution::residual:
            return follow_layers(asked_error, context);
        case Solution::in_view:
            return follow_view(asked_error, context);
    }
}

std::vector<Index> FrameRefinement::rows_changed(const KeptRows& kept, const Context& context) const {
    if (kept.rows == rows_) return {};
    return changed_rows(kept.rows->factors.matrix, rows_->factors.matrix, context);
}

/// Leads the incremental solution of the frame before to this frame's problem, or begins one.
void FrameRefinement::change_incremental(std::optional<KeptRows>& kept, const Context& context) {
    if (kept)
        change(*kept->incremental, problem(), rows_changed(*kept, context), context);
    else
        kept.emplace().incremental = make_incremental_state(problem(), context);
}

void FrameRefinement::follow_changes(double asked_error, const Context& context) {
    prepare_rows(context);
    const Stopwatch watch;
    // Left for good only once all is done, as in follow_layers.
    std::optional<KeptRows> kept = std::exchange(parts_.kept_rows, std::nullopt);
    ProgressiveConfig config;
    config.asked_error = asked_error;
    if (kept) config = following_config(asked_error);
    change_incremental(kept, context);
    const std::uint64_t shots_before = kept->incremental->shots;
    do {
        certificate_ = step(*kept->incremental, problem(), rows_->columns, config, context.part(0.6, 0.8));
    } while (kept->incremental->status == ProgressiveStatus::running);
    take_rows_light(*kept->incremental, shots_before);
    kept->rows = rows_;
    statistics_.solve += watch.elapsed();
    parts_.kept_rows = std::move(kept);
}

void FrameRefinement::follow_active(double asked_error, const Context& context) {
    prepare_rows(context);
    const Stopwatch watch;
    const PatchRoleLists lists = roles_at(parts_, frame_, statistics_.rays_traced, context);
    std::optional<KeptRows> kept = std::exchange(parts_.kept_rows, std::nullopt);
    ActivePassiveConfig config;
    config.asked_error = asked_error;
    if (kept)
        change(*kept->active_passive, problem(), rows_changed(*kept, context), lists.view(), config, context);
    else
        kept.emplace().active_passive = make_active_passive_state(problem(), lists.view(), config, context);
    ActivePassiveState& light = *kept->active_passive;
    const std::uint64_t shots_before = light.shots;
    do {
        certificate_ = step(light, problem(), rows_->columns, lists.view(), config, context.part(0.6, 0.8));
    } while (light.status == ProgressiveStatus::running);
    take_rows_light(light, shots_before);
    statistics_.active_patches =
        static_cast<std::uint64_t>(std::count(light.active.begin(), light.active.end(), std::uint8_t{1}));
    kept->rows = rows_;
    statistics_.solve += watch.elapsed();
    parts_.kept_rows = std::move(kept);
}

void FrameRefinement::follow_view(double asked_error, const Context& context) {
    prepare_rows(context);
    const Stopwatch watch;
    std::optional<KeptRows> kept = std::exchange(parts_.kept_rows, std::nullopt);
    std::optional<KeptView> view;
    if (kept && kept->rows == rows_) view = std::move(kept->view);
    change_incremental(kept, context);
    if (!view || !view->frames.contains(frame_))
        view = look_ahead(parts_, rows_->factors.matrix, std::move(view), frame_, statistics_.rays_traced,
                          context);
    IncrementalState& light = *kept->incremental;
    const std::uint64_t shots_before = light.shots;
    // As long as nothing changes and the view is known, nothing is to be done.
    if (light.status == ProgressiveStatus::running || !view->certificate)
        view->certificate = step_in_view(light, problem(), rows_->columns, view->rows, view->seen,
                                         {.asked_error = asked_error}, context.part(0.6, 0.8));
    certificate_ = *view->certificate;
    take_rows_light(light, shots_before);
    statistics_.active_patches =
        static_cast<std::uint64_t>(std::count_if(view->rows.group.begin(), view->rows.group.end(),
                                                 [&](Index group) { return view->seen[group] != 0; }));
    kept->rows = rows_;
    kept->view = std::move(view);
    statistics_.solve += watch.elapsed();
    parts_.kept_rows = std::move(kept);
}

void FrameRefinement::follow_layers(double asked_error, const Context& context) {
    const Stopwatch looking;
    // Left for good only once all is done: a stop in the middle leaves nothing half brought up to date.
    std::optional<KeptLight> kept = std::exchange(parts_.kept_light, std::nullopt);
    auto listed = parts_.strategy->take_changes();
    if (!kept) {
        kept.emplace(KeptLight{make_layered_matrix(parts_.layers(), context), std::nullopt});
        listed.reset();
    }
    const auto changes =
        listed ? show(kept->matrix, parts_.layers(), parts_.visible, std::move(*listed), context)
               : show(kept->matrix, parts_.layers(), parts_.visible, context);
    light_from_outside(kept->matrix.valid_share, kept->matrix.sky, context);
    statistics_.visibility += looking.elapsed();
    statistics_.visibility_changes = lines_changed(changes);

    const Stopwatch watch;
    context.report(0.6, "solving the light");
    const ResidualProblem problem{kept->matrix, parts_.mesh.area_m2, emission_, reflectance_, outside_};
    if (kept->state)
        afterglow::follow(*kept->state, problem, changes, context);
    else if (parts_.radiosity_before.empty())
        kept->state = make_residual_state(problem, context);
    else
        kept->state = make_residual_state(problem, parts_.radiosity_before, context);
    parts_.radiosity_before.clear();
    ResidualConfig config;
    config.asked_error = asked_error;
    const std::uint64_t pushes_before = kept->state->pushes;
    do {
        certificate_ = step(*kept->state, problem, config, context.part(0.6, 0.8));
    } while (kept->state->status == ResidualStatus::running);
    irradiance_ = kept->state->irradiance;
    from_lamps_ = lamp_irradiance(kept->matrix, parts_.lamps, emission_, context);
    valid_share_ = kept->matrix.valid_share;
    exhausted_ = kept->state->status == ResidualStatus::exhausted;
    note_solution(kept->state->pushes - pushes_before);
    statistics_.solve += watch.elapsed();
    parts_.kept_light = std::move(kept);
}

void FrameRefinement::note_solution(std::uint64_t shots) {
    statistics_.shots += shots;
    statistics_.residual = certificate_.residual;
    statistics_.error_bound = certificate_.error_bound;
    statistics_.active_patches = parts_.mesh.size();
}

/// Of the compiled rows.
std::vector<Rgb> FrameRefinement::irradiance_from_lamps() const {
    std::vector<Rgb> irradiance(parts_.mesh.size(), Rgb(0));
    for (const Index lamp : parts_.lamps.patches)
        for (std::uint64_t k = rows_->columns.column_begin[lamp]; k < rows_->columns.column_begin[lamp + 1];
             ++k)
            irradiance[rows_->columns.row[k]] += rows_->columns.value[k] * emission_[lamp];
    return irradiance;
}

/// The part of the solution that a picture does not take point by point.
std::vector<Rgb> FrameRefinement::indirect_irradiance() const {
    std::vector<Rgb> indirect = irradiance_;
    // All are sums of the same terms in another order: what rounding leaves below zero is zero.
    for (std::size_t p = 0; p < indirect.size(); ++p)
        indirect[p] = glm::max(indirect[p] - from_lights_[p] - from_lamps_[p], Rgb(0));
    return indirect;
}

/// Of all patches, W/m².
std::vector<Rgb> FrameRefinement::radiosity() const {
    std::vector<Rgb> out = irradiance_;
    for (std::size_t p = 0; p < out.size(); ++p) out[p] = emission_[p] + reflectance_[p] * out[p];
    return out;
}

DirectLight FrameRefinement::direct_light() const {
    return {parts_.mesh, parts_.lamps, parts_.caster, emission_};
}

LitWorld FrameRefinement::lit_by(std::span<const Rgb> irradiance) const {
    LitWorld lit;
    lit.world = &parts_.world;
    lit.mesh = &parts_.mesh;
    lit.interpolation = &*parts_.interpolation;
    lit.normals = &*parts_.normals;
    lit.caster = &parts_.caster;
    lit.materials = materials_;
    lit.irradiance = irradiance;
    lit.confidence = valid_share_;
    lit.lift_m = parts_.sight->lift_m();
    return lit;
}

Picture FrameRefinement::preliminary_picture(int width, int height, const Context& context) {
    const Stopwatch watch;
    context.report(0.8, "rendering the picture");
    // A solution that follows the last frame has no light on its way that would show.
    const auto irradiance = light_ ? irradiance_with_ambient(problem(), *light_) : irradiance_;
    const CameraView view = view_at(parts_.camera, time_s_, width, height);
    Picture made = render_picture(view, lit_by(irradiance), {1, 1, 0, 0, parts_.config.seed},
                                  statistics_.rays_traced, context);
    statistics_.image += watch.elapsed();
    return made;
}

Picture FrameRefinement::final_picture(const Context& context) {
    const Stopwatch watch;
    context.report(0.8, "rendering the picture");
    const auto indirect = indirect_irradiance();
    const DirectLight direct = direct_light();
    LitWorld lit = lit_by(indirect);
    lit.direct = &direct;
    lit.lights = lights_;
    const CameraView view = view_at(parts_.camera, time_s_, parts_.config.width, parts_.config.height);
    const QualityLevel level = level_of(parts_.config);
    Picture made;
    // What a single frame would keep costs more than it can save.
    if (parts_.camera.path.moves() || parts_.config.frames_expected == 1) {
        made = render_picture(view, lit, level.picture, statistics_.rays_traced, context);
    } else {
        const KeptPictureConfig config{level.picture, level.picture_tolerance};
        statistics_.rays_traced += step(parts_.picture, view, lit, config, context).rays_traced;
        made = parts_.picture.picture;
    }
    statistics_.image += watch.elapsed();
    return made;
}

const ProbeEstimate& FrameRefinement::probe(const Picture& final_picture, const Context& context) {
    if (probed_) return *probed_;
    const Stopwatch watch;
    context.report(0.9, "estimating the picture's error");
    const DirectLight direct = direct_light();
    const PathScene scene{&parts_.world, &parts_.caster, materials_,
                          &direct,       lights_,        parts_.sight->lift_m()};
    const CameraView view = view_at(parts_.camera, time_s_, final_picture.width, final_picture.height);
    probed_ = afterglow::estimate_error(final_picture, view, scene, level_of(parts_.config).probes,
                                        statistics_.rays_traced, context);
    statistics_.image += watch.elapsed();
    return *probed_;
}

void FrameRefinement::estimate_error(const Picture& final_picture, const Context& context) {
    const ProbeEstimate& estimate = probe(final_picture, context);
    const Stopwatch watch;
    compile(context);
    const SeenLines seen{parts_.visible.patch, directions_, parts_.visible.light_contribution};
    const auto differences = half_differences(*parts_.sight, parts_.lamps, seen, rows_->factors, radiosity(),
                                              pi * parts_.world.background, context);
    const CameraView view = view_at(parts_.camera, time_s_, final_picture.width, final_picture.height);
    statistics_.picture_error = estimate.relative_error;
    statistics_.picture_error_spread = estimate.standard_error;
    statistics_.line_noise =
        line_noise(final_picture, view, lit_by(differences), statistics_.rays_traced, context);
    statistics_.image += watch.elapsed();
}

void FrameRefinement::add_cost(const FrameStatistics& earlier) {
    statistics_.visibility += earlier.visibility;
    statistics_.solve += earlier.solve;
    statistics_.image += earlier.image;
    statistics_.rays_traced += earlier.rays_traced;
    statistics_.shots += earlier.shots;
}

}  // namespace afterglow
