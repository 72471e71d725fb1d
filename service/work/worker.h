#pragma once

#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <thread>

#include "service/store/job_store.h"
#include "service/work/child_run.h"
#include "service/work/encoder.h"
#include "service/work/job_run.h"
#include "service/work/schedule.h"

namespace afterglow {

struct WorkerConfig {
    int threads = 0;               ///< for the solver; 0: one a core
    std::size_t max_resident = 4;  ///< jobs whose solver state is in memory at a time
    int max_strikes = 3;           ///< a job fails when this many processes have ended at one frame of it
};

/// The one thread by which anything is computed. It owns every run, gives each running job a frame at a time,
/// and survives whatever a job throws. A job whose process has ended begins anew after its last finished
/// frame. Thread-safety: all members.
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
    /// Changes which jobs go first; from the next turn on. False: the job has ended.
    bool set_priority(const std::string& job, int priority);
    /// Has a job's new edits taken over: its running state is kept where there is one, and goes on with the
    /// first frame that is stale or missing.
    void take_edits(const std::string& job);
    /// Pauses the job: its run is abandoned and its state freed. False: not legal now.
    bool pause(const std::string& job);
    /// Stops computing at the next check and for good; jobs stay as they are.
    void halt();
    /// Ends the job now; its run is abandoned and its state freed. False: it had ended.
    bool cancel(const std::string& job);

  private:
    struct Running {
        std::unique_ptr<JobRun> run;
        int next_frame = 0;
        int revision = 0;         ///< of the job that the run is at
        std::size_t applied = 0;  ///< edits taken over of the request that follows it
        double kept = 1;          ///< share of lines kept by them
    };
    void loop();
    std::optional<std::string> wait_for_turn();
    void take_turn(const std::string& id);
    [[nodiscard]] int first_frame_of(const Job& job);
    void leave(const std::string& id);
    void abandon(const std::string& id);
    std::stop_token new_abandon_token(const std::string& id);
    bool strike(const std::string& id, const ChildDied& death);
    void advance(const Job& job, const std::stop_token& stop);
    void take_over(const Job& job, Running& running, const Context& context);
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
    std::set<std::string> edited_;     ///< since their last turn; what runs of them goes on
    std::map<std::string, std::stop_source> abandon_;  ///< of runs
    std::string in_hand_;                              ///< the job whose turn it is
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace afterglow
