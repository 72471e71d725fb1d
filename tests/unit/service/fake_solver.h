#pragma once

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <limits>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "service/store/scene_survey.h"
#include "service/work/job_run.h"
#include "solver/base/error.h"

// Stand-ins for the solver with which tests of the service decide what happens when.

namespace afterglow {

/// A folder of its own that is removed at the end.
class ScratchFolder {
  public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// One lit triangle and a camera named "eye", 10 frames long. Text that begins with "bad" is refused.
Scene fake_scene(std::string_view bytes, const SceneUpload& upload);

/// What all fake runs of a test share.
class FakeSolver {
  public:
    static constexpr int revisions = 4;
    static constexpr std::uint64_t failing_seed = 13;   ///< fails at the job's second frame
    static constexpr std::uint64_t throwing_seed = 14;  ///< throws what is no Error
    static constexpr std::uint64_t hanging_seed = 15;   ///< computes its first frame until it is stopped

    RunFactory factory();
    /// Holds every frame at its beginning until `open`.
    void close();
    void open();
    /// Lets so many steps begin in all, and holds the next one until `open`.
    void close_after(std::size_t steps);
    /// (job, frame) of every step begun, in order.
    std::vector<std::pair<std::string, int>> steps() const;
    /// Kinds of the edits that runs took over, in order; each keeps half of the lines.
    std::vector<std::string> edits() const;
    /// Runs that exist at this moment.
    int alive() const { return alive_; }

  private:
    friend class FakeRun;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool is_open_ = true;
    std::size_t most_steps_ = std::numeric_limits<std::size_t>::max();
    std::vector<std::pair<std::string, int>> steps_;
    std::vector<std::string> edits_;
    std::atomic<int> alive_ = 0;
};

/// A small picture of one grey; the last revision is final.
Revision fake_revision(int frame, int revision, int last_revision = FakeSolver::revisions);

}  // namespace afterglow
