#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "service/base/child_process.h"
#include "service/store/scene_store.h"
#include "service/work/job_run.h"

namespace afterglow {

/// The process that computed a job ended before its work did, or can do no more for want of memory.
class ChildDied : public std::runtime_error {
  public:
    enum class Cause { ended, memory };
    ChildDied(Cause cause, const std::string& words) : std::runtime_error(words), cause_(cause) {}
    [[nodiscard]] Cause cause() const { return cause_; }

  private:
    Cause cause_;
};

struct ChildRunConfig {
    std::filesystem::path cache_folder;                ///< static rows are kept here
    ChildLimits limits;                                ///< of each job's process
    std::filesystem::path program = "/proc/self/exe";  ///< what is started; for tests
};

/// Runs each in a process of its own, which is killed as soon as the run is abandoned or goes. A stop of a
/// step is heard at the next check there and leaves the run usable. Errors of making and stepping also:
/// ChildDied, after which the run is of no more use.
RunFactory child_runs(const SceneStore& scenes, ChildRunConfig config);

}  // namespace afterglow
