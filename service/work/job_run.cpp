#include "service/work/job_run.h"

#include <utility>

#include "service/base/overloaded.h"
#include "solver/scene/named.h"
#include "solver/sequence/furniture_edits.h"

namespace afterglow {

namespace {

EditOutcome apply_to(SequenceState& state, const std::string& camera, const Edit& edit,
                     const Context& context) {
    const World& world = state.world();
    const auto change = Overloaded{
        [&](const MoveEdit& move) {
            if (kind_of(world, move.node) == ObjectKind::actor)
                return set_path(state, move.node, 0, path_of(world, move), context);
            const Index piece = index_named(world.pieces, 0, move.node, "piece");
            return move_furniture(state, move.node, motion_of(world, piece, move.shift), context);
        },
        [&](const LightEdit& edited) {
            const Rgb light = edited.light.value_or(Rgb(0));
            if (edited.of == LightEdit::Of::lamp) return set_intensity(state, edited.name, light);
            return set_emission(state, edited.name, light, context);
        },
        [&](const MaterialEdit& material) {
            return set_reflectance(state, material.material, material.reflectance);
        },
        [&](const CameraEdit& placed) { return set_camera(state, camera_of(world, camera, placed)); },
        [&](const PathEdit& path) {
            return set_path(state, path.node, path.from_s, path_of(world, path), context);
        },
        [&](const RemoveEdit& removed) { return remove_furniture(state, removed.node, context); },
        [&](const AddEdit& added) { return add_furniture(state, object_of(world, added), context); },
    };
    return std::visit(change, edit.what);
}

class SolverRun : public JobRun {
  public:
    SolverRun(SequenceState state, std::string camera)
        : state_(std::move(state)), camera_(std::move(camera)) {}

    FrameStatistics step(int frame, const RevisionSink& on_revision, const Context& context) override {
        return afterglow::step(state_, frame, on_revision, context);
    }
    EditOutcome apply(const Edit& edit, const Context& context) override {
        return apply_to(state_, camera_, edit, context);
    }
    [[nodiscard]] SequenceStatistics statistics() const override { return state_.statistics(); }
    [[nodiscard]] Warnings warnings() const override { return state_.warnings(); }

  private:
    SequenceState state_;
    std::string camera_;  ///< as the job was submitted with
};

/// The edits of a job, one after the other.
std::vector<const Edit*> edits_of(const Job& job) {
    std::vector<const Edit*> edits;
    for (const JobEdit& request : job.edits)
        for (const Edit& edit : request.edits) edits.push_back(&edit);
    return edits;
}

}  // namespace

std::unique_ptr<JobRun> solver_run(const Job& job, World world, const std::filesystem::path& cache_folder,
                                   const Context& context) {
    SequenceConfig config = job.settings.sequence;
    config.cache_folder = cache_folder;
    config.frames_expected = job.frame_count();
    // An edited scene's own exposure would be another than that of the pictures there are.
    if (!config.exposure_ev) config.exposure_ev = job.statistics.exposure_ev;
    const auto edits = edits_of(job);
    for (const Edit* edit : edits) apply(world, *edit);
    auto run = std::make_unique<SolverRun>(make_state(std::move(world), config, context), config.camera);
    for (const Edit* edit : edits)
        if (std::holds_alternative<CameraEdit>(edit->what)) run->apply(*edit, context);
    return run;
}

}  // namespace afterglow
