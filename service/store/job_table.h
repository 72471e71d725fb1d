#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "service/jobs/job.h"
#include "service/store/database.h"

namespace afterglow {

/// The jobs of a database. What a call has returned from is durable. Errors: StorageError. Thread-safety: all
/// members.
class JobTable {
  public:
    /// Forgets pictures that were finished while their job was being removed.
    explicit JobTable(Database& database);

    /// A job and its number: they grow in the order in which jobs were added.
    struct Entry {
        std::int64_t number = 0;
        Job job;
    };
    std::optional<Entry> find(const std::string& id);
    /// The id of the job that a client submitted with a key.
    std::optional<std::string> with_key(const std::string& owner, const std::string& key);
    /// Those that have not ended, in the order they were added.
    std::vector<Entry> unended();
    /// At most `limit`, newest first, of numbers below `before`; all, or those of one state as it is in the
    /// table. What their edits do is left out.
    std::vector<Entry> page(std::int64_t before, const std::optional<JobState>& state, std::size_t limit);
    /// The ids of jobs that have ended and still have their pictures.
    std::vector<std::string> with_frames_at_rest();
    /// The ids of scenes and paths that any job has, and the empty id where one has no paths.
    std::set<std::string> uploads_used();
    /// How many there are of each state that there is, as it is in the table.
    std::map<JobState, std::int64_t> count_by_state();
    /// Finished frames that no edit has made stale, of all jobs.
    std::int64_t count_frames();

    /// Returns the job's number.
    std::int64_t add(const Job& job);
    void update(const Job& job);
    /// As `update`; the rows of its frames go at the same time.
    void forget_frames(const Job& job);
    /// The body is left as it is.
    void set_strikes(const std::string& id, int strikes, int frame);
    /// Adds the newest of its edits and updates the job, both or neither.
    void add_edit(const Job& job);
    /// How much of its lines the job kept, of an edit that was added.
    void update_reused(const Job& job, int revision);
    /// Its frames, edits and events too.
    void remove(const std::string& id);

    /// The durable frames of a job, in order.
    std::vector<FrameInfo> frames_of(const std::string& id);
    /// The events of a job at rest, as text; nothing where none were kept.
    std::optional<std::string> events_of(const std::string& id);
    /// As `update`, with the job's events as text.
    void put_to_rest(const Job& job, const std::string& events);
    void drop_events(const std::string& id);

  private:
    enum class Edits { whole, places_only };
    std::vector<Entry> select(const std::string& condition, const Row& values, Edits edits);

    Database& database_;
};

}  // namespace afterglow
