#include "service/work/job_run.h"

#include <utility>

namespace afterglow {

namespace {

class SolverRun : public JobRun {
  public:
    explicit SolverRun(SequenceState state) : state_(std::move(state)) {}

    FrameStatistics step(int frame, const RevisionSink& on_revision, const Context& context) override {
        return afterglow::step(state_, frame, on_revision, context);
    }
    [[nodiscard]] SequenceStatistics statistics() const override { return state_.statistics(); }
    [[nodiscard]] Warnings warnings() const override { return state_.warnings(); }

  private:
    SequenceState state_;
};

}  // namespace

RunFactory solver_runs(const SceneStore& scenes, std::filesystem::path cache_folder) {
    return [&scenes, cache = std::move(cache_folder)](const Job& job, const Context& context) {
        SequenceConfig config = job.settings.sequence;
        config.cache_folder = cache;
        config.frames_expected = job.frame_count();
        World world = scenes.world(job.scene, job.paths, job.settings.background);
        return std::make_unique<SolverRun>(make_state(std::move(world), config, context));
    };
}

}  // namespace afterglow
