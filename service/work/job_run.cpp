#include "service/work/job_run.h"

#include <optional>
#include <utility>
#include <vector>

#include "service/base/overloaded.h"
#include "solver/scene/named.h"
#include "solver/sequence/furniture_edits.h"
#include "solver/sequence/sketch.h"

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

/// The edits of a job, one after the other.
std::vector<const Edit*> edits_of(const Job& job) {
    std::vector<const Edit*> edits;
    for (const JobEdit& request : job.edits)
        for (const Edit& edit : request.edits) edits.push_back(&edit);
    return edits;
}

/// Whoever watches a job sees a sketch of its first frame before there are patches.
class SolverRun : public JobRun {
  public:
    /// `world` has the job's edits, but for those of the camera.
    SolverRun(const Job& job, World world, SequenceConfig config, const Context& context)
        : world_(std::move(world)), config_(std::move(config)) {
        for (const Edit* edit : edits_of(job))
            if (std::holds_alternative<CameraEdit>(edit->what)) cameras_.push_back(*edit);
        if (config_.revisions == Revisions::all)
            sketched_ = with_cameras(make_sketch_state(world_, config_, context), context);
        else
            prepare(context);
    }

    FrameStatistics step(int frame, const RevisionSink& on_revision, const Context& context) override {
        if (state_) return afterglow::step(*state_, frame, on_revision, context);
        on_revision(sketch(*sketched_, frame, context.part(0, 0.01)));
        prepare(context.part(0.01, 0.05));
        const auto later = [&](Revision revision) {
            ++revision.revision;
            on_revision(revision);
        };
        return afterglow::step(*state_, frame, later, context.part(0.05, 1));
    }
    EditOutcome apply(const Edit& edit, const Context& context) override {
        prepare(context);
        return apply_to(*state_, config_.camera, edit, context);
    }
    [[nodiscard]] SequenceStatistics statistics() const override {
        return state_ ? state_->statistics() : SequenceStatistics{};
    }
    [[nodiscard]] Warnings warnings() const override { return state_ ? state_->warnings() : Warnings{}; }

  private:
    /// A stop in the middle leaves everything for another attempt.
    void prepare(const Context& context) {
        if (state_) return;
        state_ = with_cameras(make_state(world_, config_, context), context);
        sketched_.reset();
        world_ = {};
    }
    [[nodiscard]] SequenceState with_cameras(SequenceState state, const Context& context) const {
        for (const Edit& edit : cameras_) apply_to(state, config_.camera, edit, context);
        return state;
    }

    World world_;  ///< until `state_` is made from it
    SequenceConfig config_;
    std::vector<Edit> cameras_;
    std::optional<SequenceState> sketched_, state_;
};

}  // namespace

std::unique_ptr<JobRun> solver_run(const Job& job, World world, const std::filesystem::path& cache_folder,
                                   const Context& context) {
    SequenceConfig config = job.settings.sequence;
    config.cache_folder = cache_folder;
    config.frames_expected = job.frame_count();
    // An edited scene's own exposure would be another than that of the pictures there are.
    if (!config.exposure_ev) config.exposure_ev = job.statistics.exposure_ev;
    config.made_for_error = job.statistics.made_for_error;
    for (const Edit* edit : edits_of(job)) apply(world, *edit);
    return std::make_unique<SolverRun>(job, std::move(world), std::move(config), context);
}

}  // namespace afterglow
