#pragma once

#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "service/store/job_store.h"
#include "service/work/encoder.h"
#include "service/work/job_run.h"
#include "service/work/schedule.h"

namespace afterglow {

struct WorkerConfig {
    int threads = 0;               ///< for the solver; 0: one a core
    std::size_t max_resident = 4;  ///< jobs whose solver state is in memory at a time
};

/// The one thread that computes. It owns every solver state, gives each running job a frame at a time, and
/// survives whatever a job throws. Thread-safety: all members.
class Worker {
  public:
    Worker(JobStore& jobs, Encoder& encoder, RunFactory make_run, WorkerConfig config = {});
    /// Stops the job in hand; jobs that have not ended are left as they are.
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Takes a queued job of the store; also one that is tried again. It goes on after its last finished
    /// frame.
    void submit(const std::string& job);
    /// Pauses the job: its computation stops at its next check and its state is freed. False: not legal now.
    bool pause(const std::string& job);
    /// Stops computing at the next check and for good; jobs stay as they are.
    void halt();
    /// Ends the job now; the computation stops at its next check and its state is freed. False: it had ended.
    bool cancel(const std::string& job);

  private:
    struct Running {
        std::unique_ptr<JobRun> run;
        int next_frame = 0;
    };
    void loop();
    std::optional<std::string> wait_for_turn();
    void take_turn(const std::string& id);
    [[nodiscard]] int first_frame_of(const Job& job);
    void leave(const std::string& id);
    void advance(const Job& job);
    void compute_frame(const Job& job, Running& running, const Context& context);
    void drop_ended();

    JobStore& jobs_;
    Encoder& encoder_;
    RunFactory make_run_;
    WorkerConfig config_;
    std::map<std::string, Running> running_;  ///< touched by the compute thread only
    std::mutex mutex_;
    std::condition_variable changed_;
    Schedule schedule_;
    std::set<std::string> submitted_;  ///< since their last turn; what runs of them is of an earlier attempt
    std::string in_hand_;              ///< the job whose turn it is
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace afterglow
