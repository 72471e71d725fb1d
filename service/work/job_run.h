#pragma once

#include <functional>
#include <memory>

#include "service/jobs/job.h"
#include "service/store/scene_store.h"
#include "solver/base/context.h"
#include "solver/sequence/sequence.h"

namespace afterglow {

/// A job being computed: everything the solver keeps for it from frame to frame. One thread at a time.
class JobRun {
  public:
    virtual ~JobRun() = default;
    /// As afterglow::step.
    virtual FrameStatistics step(int frame, const RevisionSink& on_revision, const Context& context) = 0;
    [[nodiscard]] virtual SequenceStatistics statistics() const = 0;
    [[nodiscard]] virtual Warnings warnings() const = 0;
};

/// Prepares a job. Errors: whatever makes it impossible.
using RunFactory = std::function<std::unique_ptr<JobRun>(const Job& job, const Context& context)>;

/// Runs by the solver: reads the job's scene from the store and makes its state; static rows are cached in
/// `cache_folder`.
RunFactory solver_runs(const SceneStore& scenes, std::filesystem::path cache_folder);

}  // namespace afterglow
