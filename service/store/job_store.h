#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "service/jobs/event_log.h"
#include "service/jobs/frame_info.h"
#include "service/jobs/job.h"
#include "service/store/job_table.h"
#include "solver/base/context.h"

namespace afterglow {

struct JobStoreConfig {
    EventLogConfig events;                             ///< of each job
    std::chrono::milliseconds progress_interval{100};  ///< least time between two progress events of a job
    std::uint64_t first_event = 0;                     ///< ids of events begin after it
};

/// All jobs with their events. Every change of a job goes through here, is checked against the legal
/// transitions and told to its readers. Changes to a job that has ended or does not exist do nothing: whoever
/// comes last with news of a cancelled job need not know. Thread-safety: all members.
class JobStore {
  public:
    /// Without a table nothing outlasts the process. `frames`: the pictures of the jobs in the table.
    explicit JobStore(JobStoreConfig config = {}, JobTable* table = nullptr,
                      const std::map<std::string, std::vector<FrameInfo>>& frames = {});

    /// Gives the job its id and its place in the list. The draft has scene, paths, settings, frames and
    /// warnings. It is durable on return. A draft whose owner has a job with the same idempotency key gives
    /// that job. Errors: StorageError; ProblemError 422 where that job was asked for differently.
    Job add(Job draft);
    /// The job that a draft repeats by its key, or nothing. Errors as of `add`.
    [[nodiscard]] std::optional<Job> repeated(const Job& draft) const;
    [[nodiscard]] std::optional<Job> find(const std::string& id) const;
    /// Newest first.
    [[nodiscard]] std::vector<Job> list() const;
    /// Null for an unknown id.
    [[nodiscard]] std::shared_ptr<const EventLog> events(const std::string& id) const;
    /// Stopped as soon as the job has ended for whatever reason.
    [[nodiscard]] std::stop_token stop_token(const std::string& id) const;

    /// queued → running. False: the job has ended.
    bool start(const std::string& id);
    /// The job ends, and its work is told to stop. False: it had ended before.
    bool end(const std::string& id, JobState state, const std::optional<Problem>& error = std::nullopt);
    /// queued or running → paused; its work is told to stop. False: that is not legal now.
    bool pause(const std::string& id);
    /// paused, failed or cancelled → queued. False: that is not legal now.
    bool requeue(const std::string& id);
    /// Tells the work on a job to stop without changing the job.
    void interrupt(const std::string& id) const;
    /// Forgets a job that has ended. False: there is none, or it has not ended.
    bool remove(const std::string& id);
    /// Lets every reader finish; jobs stay as they are.
    void close_streams();

    /// How far the computation of one frame is; `frames_before`: frames of the job already computed.
    void note_progress(const std::string& id, int frame, int frames_before, const Progress& progress);
    void note_statistics(const std::string& id, const SequenceStatistics& statistics);
    /// Adds those warnings that the job does not have yet.
    void note_warnings(const std::string& id, const Warnings& warnings);
    /// A picture can now be fetched.
    void note_picture(const std::string& id, const FrameInfo& info);
    /// A final picture that was told of could not be kept: its frame counts as unfinished again.
    void forget_picture(const std::string& id, int frame);
    /// The first frame of a job that is not finished; one past its last where all are.
    [[nodiscard]] int first_unfinished(const std::string& id) const;

  private:
    struct Record {
        Job job;
        std::shared_ptr<EventLog> events;
        std::stop_source stop;
        std::chrono::steady_clock::time_point last_progress;
        std::set<int> final_frames = {};
    };
    Record* active(const std::string& id);
    void restore(const Job& job, const std::vector<FrameInfo>& frames);
    [[nodiscard]] const Job* with_key(const Job& draft) const;
    void save(const Job& job) const;
    void take_over(Record& record, Job job) const;
    void save_or_tell(const Job& job) const;

    JobStoreConfig config_;
    JobTable* table_;
    mutable std::mutex mutex_;
    std::map<std::string, Record> records_;
    std::vector<std::string> order_;  ///< ids, oldest first
};

}  // namespace afterglow
