#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>

#include "service/jobs/job.h"
#include "solver/base/context.h"
#include "solver/scene/world.h"
#include "solver/sequence/edits.h"

namespace afterglow {

/// A job being computed: everything the solver keeps for it from frame to frame. One thread at a time.
class JobRun {
  public:
    virtual ~JobRun() = default;
    /// As afterglow::step.
    virtual FrameStatistics step(int frame, const RevisionSink& on_revision, const Context& context) = 0;
    /// Takes over an edit between two steps. Errors: cancelled leaves the run as it was, for another attempt;
    /// others as in edits.h and furniture_edits.h.
    virtual EditOutcome apply(const Edit& edit, const Context& context) = 0;
    [[nodiscard]] virtual SequenceStatistics statistics() const = 0;
    [[nodiscard]] virtual Warnings warnings() const = 0;
};

/// Prepares a job with the edits it has. Once `abandoned` is stopped nobody wants the run any more, whatever
/// it does then. Errors: whatever makes it impossible.
using RunFactory = std::function<std::unique_ptr<JobRun>(const Job& job, const Context& context,
                                                         const std::stop_token& abandoned)>;

/// A run by the solver in this process, of a world that the job's edits are still to be applied to; static
/// rows are cached in `cache_folder`. Errors: those of make_state.
std::unique_ptr<JobRun> solver_run(const Job& job, World world, const std::filesystem::path& cache_folder,
                                   const Context& context);

}  // namespace afterglow
