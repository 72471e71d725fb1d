#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
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
    std::size_t ended_in_memory = 16;                  ///< jobs that have ended, with a table; 1 or more
    /// Told of each job that leaves the memory, under the store's lock. Nothing: nobody is.
    std::function<void(const std::string& id)> at_rest = {};
};

/// Which jobs are listed: those after a job of this id (empty: from the newest) and, where given, of one
/// state.
struct JobQuery {
    std::string after = {};
    std::optional<JobState> state = {};
    std::size_t limit = std::numeric_limits<std::size_t>::max();
};

/// All jobs with their events. With a table, of jobs that have ended only the last few are in memory; the
/// others are read from it when they are asked for. Every change of a job goes through here, is checked
/// against the legal transitions and told to its readers. Changes to a job that has ended or does not exist
/// do nothing: whoever comes last with news of a cancelled job need not know. Thread-safety: all members.
class JobStore {
  public:
    /// Without a table nothing outlasts the process.
    explicit JobStore(JobStoreConfig config = {}, JobTable* table = nullptr);

    /// Gives the job its id and its place in the list. The draft has scene, paths, settings, frames and
    /// warnings. It is durable on return. A draft whose owner has a job with the same idempotency key gives
    /// that job. Errors: StorageError; ProblemError 422 where that job was asked for differently.
    Job add(Job draft);
    /// The job that a draft repeats by its key, or nothing. Errors as of `add`.
    [[nodiscard]] std::optional<Job> repeated(const Job& draft) const;
    [[nodiscard]] std::optional<Job> find(const std::string& id) const;
    /// Newest first; what their edits do may be left out. Nothing where `after` is unknown.
    [[nodiscard]] std::optional<std::vector<Job>> list(const JobQuery& query = {}) const;
    /// Those that have not ended, oldest first.
    [[nodiscard]] std::vector<Job> unended() const;
    /// Those that have ended and still have their pictures.
    [[nodiscard]] std::vector<Job> ended_with_frames() const;
    /// The ids of scenes and paths that any of them has, and the empty id where one has no paths.
    [[nodiscard]] std::set<std::string> uploads_used() const;
    struct Counts {
        std::map<JobState, std::int64_t> jobs;  ///< by each state that there is
        std::int64_t frames = 0;                ///< finished, of all jobs
    };
    [[nodiscard]] Counts counts() const;
    /// What is in memory now.
    struct Held {
        std::size_t jobs = 0;
        std::size_t events = 0;
    };
    [[nodiscard]] Held held() const;
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
    /// Changes a job's place among others, before its end. False: it has ended, or there is none. Errors:
    /// StorageError.
    bool set_priority(const std::string& id, int priority);
    /// Tells the work on a job to stop without changing the job.
    void interrupt(const std::string& id) const;
    enum class EditResult {
        accepted,
        stale,    ///< the job has another revision by now
        illegal,  ///< its state does not allow it, or there is no such job
    };
    /// Adds edits to a job of a given revision, durable on return: pictures that show what is no more become
    /// stale, the work in hand is told to stop, and an ended job is queued again. Errors: StorageError.
    EditResult edit(const std::string& id, int revision, JobEdit edit);
    /// What share of its lines the running job kept when it took over its edit of that number, from 1.
    void note_reused(const std::string& id, int revision, double share);
    /// running → succeeded, for work that took over edits up to `revision`. False: there are newer ones, or
    /// that is not legal now.
    bool succeed(const std::string& id, int revision);
    /// Forgets a job that has ended. False: there is none, or it has not ended.
    bool remove(const std::string& id);
    /// The pictures of a job that has ended go, and its events but the end: notes that as of `time`, then
    /// calls `remove` while no other change of any job can happen. False: there is no such job now.
    bool forget_frames(const std::string& id, Timestamp time, const std::function<void()>& remove);
    /// Lets every reader finish; jobs stay as they are.
    void close_streams();

    /// How far the computation of one frame is; `frames_before`: frames of the job already computed.
    void note_progress(const std::string& id, int frame, int frames_before, const Progress& progress);
    void note_statistics(const std::string& id, const SequenceStatistics& statistics);
    /// Adds those warnings that the job does not have yet.
    void note_warnings(const std::string& id, const Warnings& warnings);
    /// A picture can now be fetched.
    void note_picture(const std::string& id, const FrameInfo& info);
    /// The process that computed a frame has ended before it was done. Returns how often that has happened
    /// with this frame since the job was last queued by its client; durable.
    int note_strike(const std::string& id, int frame);
    /// A final picture that was told of could not be kept: its frame counts as unfinished again.
    void forget_picture(const std::string& id, int frame);
    /// The first frame of a job that is not finished; one past its last where all are.
    [[nodiscard]] int first_unfinished(const std::string& id) const;

  private:
    struct Record {
        std::int64_t number = 0;  ///< grows in the order in which jobs were added
        Job job;
        std::shared_ptr<EventLog> events;
        std::stop_source stop;
        std::optional<std::chrono::steady_clock::time_point> last_progress;
        std::set<int> final_frames = {};  ///< with a final picture that holds
        std::set<int> stale_frames = {};  ///< with one from before an edit
        std::uint64_t ended = 0;          ///< the count of ends, at its own
    };
    Record* active(const std::string& id);
    static void count_frames(Record& record);
    bool end_if(const std::string& id, JobState state, const std::optional<Problem>& error,
                const std::function<bool(const Job&)>& condition);
    [[nodiscard]] Record restored(const JobTable::Entry& entry) const;
    void replay(Record& record, const std::vector<FrameInfo>& frames) const;
    Record* recall(const std::string& id);
    void put_to_rest();
    [[nodiscard]] std::vector<const Record*> newest_first() const;
    [[nodiscard]] std::optional<std::int64_t> number_of(const std::string& id) const;
    [[nodiscard]] std::optional<Job> known(const std::string& id) const;
    [[nodiscard]] std::optional<Job> with_key(const Job& draft) const;
    void save(const Job& job) const;
    void take_over(Record& record, Job job) const;
    void save_or_tell(const Job& job) const;

    JobStoreConfig config_;
    JobTable* table_;
    mutable std::mutex mutex_;
    std::map<std::string, Record> records_;
    std::int64_t last_number_ = 0;  ///< given, where there is no table to number jobs
    std::uint64_t ends_ = 0;
};

}  // namespace afterglow
