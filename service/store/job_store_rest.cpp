// Jobs that have ended, of which JobStore keeps only a few in memory, and the questions that concern them
// too.

#include <algorithm>
#include <utility>

#include "service/http/http_message.h"
#include "service/jobs/job_json.h"
#include "service/store/job_store.h"

namespace afterglow {

/// A job of the table, with its frames and its events.
JobStore::Record JobStore::restored(const JobTable::Entry& entry) const {
    Record record;
    record.number = entry.number;
    record.job = entry.job;
    const auto frames = table_->frames_of(entry.job.id);
    for (const FrameInfo& info : frames)
        (entry.job.is_stale(info) ? record.stale_frames : record.final_frames).insert(info.frame);
    if (has_ended(entry.job.state)) record.stop.request_stop();
    if (const auto kept = has_ended(entry.job.state) ? table_->events_of(entry.job.id) : std::nullopt)
        record.events = std::make_shared<EventLog>(config_.events, *kept);
    else
        replay(record, frames);
    return record;
}

/// Tells a job as it stands from the beginning: readers who had reached an id of an earlier life get all of
/// it.
void JobStore::replay(Record& record, const std::vector<FrameInfo>& frames) const {
    const Job& job = record.job;
    record.events = std::make_shared<EventLog>(config_.events, config_.first_event);
    EventLog& log = *record.events;
    log.append(EventKind::job, dump(to_json(job)));
    for (const Warning& warning : job.warnings) log.append(EventKind::warning, dump(to_json(warning)));
    for (const FrameInfo& info : frames)
        log.append(EventKind::final_image, dump(image_json(job, info)), info.frame);
    if (job.error) log.append(EventKind::error, dump(to_json(*job.error)));
    if (has_ended(job.state)) log.append(EventKind::end, dump({{"state", name_of(job.state)}}));
}

/// The record of a job, brought back into memory where it was at rest; null where there is none. Callers hold
/// the lock.
JobStore::Record* JobStore::recall(const std::string& id) {
    if (const auto it = records_.find(id); it != records_.end()) return &it->second;
    const auto entry = table_ != nullptr ? table_->find(id) : std::nullopt;
    if (!entry) return nullptr;
    put_to_rest();
    Record record = restored(*entry);
    record.ended = ++ends_;
    // What is kept there is out of date as soon as the job goes on.
    table_->drop_events(id);
    return &records_.emplace(id, std::move(record)).first->second;
}

/// Of those that have ended, only so many of the last ones stay in memory. Callers hold the lock.
void JobStore::put_to_rest() {
    if (table_ == nullptr) return;
    std::vector<Record*> ended;
    for (auto& [id, record] : records_)
        if (has_ended(record.job.state)) ended.push_back(&record);
    std::sort(ended.begin(), ended.end(), [](const auto* a, const auto* b) { return a->ended > b->ended; });
    try {
        for (; ended.size() > std::max<std::size_t>(config_.ended_in_memory, 1); ended.pop_back()) {
            const Record& record = *ended.back();
            const std::string id = record.job.id;
            table_->put_to_rest(record.job, record.events->kept());
            if (config_.at_rest) config_.at_rest(id);
            records_.erase(id);
        }
    } catch (const Error&) {
        static_cast<void>(problem_of(std::current_exception()));  // they stay in memory; tells the operator
    }
}

std::optional<std::int64_t> JobStore::number_of(const std::string& id) const {
    if (const auto it = records_.find(id); it != records_.end()) return it->second.number;
    const auto entry = table_ != nullptr ? table_->find(id) : std::nullopt;
    return entry ? std::optional(entry->number) : std::nullopt;
}

/// Callers hold the lock.
std::optional<Job> JobStore::known(const std::string& id) const {
    if (const auto it = records_.find(id); it != records_.end()) return it->second.job;
    auto entry = table_ != nullptr ? table_->find(id) : std::nullopt;
    return entry ? std::optional(std::move(entry->job)) : std::nullopt;
}

std::optional<Job> JobStore::find(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    return known(id);
}

std::shared_ptr<const EventLog> JobStore::events(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    if (const auto it = records_.find(id); it != records_.end()) return it->second.events;
    const auto entry = table_ != nullptr ? table_->find(id) : std::nullopt;
    return entry ? restored(*entry).events : nullptr;
}

/// The job that this draft repeats. Callers hold the lock.
std::optional<Job> JobStore::with_key(const Job& draft) const {
    if (draft.idempotency_key.empty()) return std::nullopt;
    std::optional<std::string> id;
    if (table_ != nullptr) id = table_->with_key(draft.owner, draft.idempotency_key);
    for (const auto& [name, record] : records_)
        if (record.job.owner == draft.owner && record.job.idempotency_key == draft.idempotency_key) id = name;
    std::optional<Job> job = id ? known(*id) : std::nullopt;
    if (job && job->idempotency_hash != draft.idempotency_hash)
        throw ProblemError(
            {422, "idempotency_key_reused", "this key came with another request before", "Idempotency-Key"});
    return job;
}

std::optional<Job> JobStore::repeated(const Job& draft) const {
    const std::lock_guard lock(mutex_);
    return with_key(draft);
}

std::vector<const JobStore::Record*> JobStore::newest_first() const {
    std::vector<const Record*> records;
    for (const auto& [id, record] : records_) records.push_back(&record);
    std::sort(records.begin(), records.end(),
              [](const auto* a, const auto* b) { return a->number > b->number; });
    return records;
}

std::optional<std::vector<Job>> JobStore::list(const JobQuery& query) const {
    const std::lock_guard lock(mutex_);
    auto before = std::numeric_limits<std::int64_t>::max();
    if (!query.after.empty()) {
        const auto number = number_of(query.after);
        if (!number) return std::nullopt;
        before = *number;
    }
    std::vector<Job> jobs;
    // Those that have not ended are all in memory; of the others what is in memory is in the table too.
    if (table_ == nullptr || (query.state && !has_ended(*query.state))) {
        for (const Record* record : newest_first())
            if (record->number < before && jobs.size() < query.limit &&
                (!query.state || record->job.state == *query.state))
                jobs.push_back(record->job);
        return jobs;
    }
    for (JobTable::Entry& entry : table_->page(before, query.state, query.limit)) {
        const auto held = records_.find(entry.job.id);
        if (held == records_.end())
            jobs.push_back(std::move(entry.job));
        else
            jobs.push_back(held->second.job);
    }
    return jobs;
}

std::vector<Job> JobStore::unended() const {
    const std::lock_guard lock(mutex_);
    std::vector<Job> jobs;
    for (const Record* record : newest_first())
        if (!has_ended(record->job.state)) jobs.push_back(record->job);
    std::reverse(jobs.begin(), jobs.end());
    return jobs;
}

std::vector<Job> JobStore::ended_with_frames() const {
    const std::lock_guard lock(mutex_);
    std::vector<Job> jobs;
    if (table_ == nullptr) {
        for (const auto& [id, record] : records_)
            if (has_ended(record.job.state) && !record.job.frames_removed) jobs.push_back(record.job);
        return jobs;
    }
    for (const std::string& id : table_->with_frames_at_rest())
        if (auto job = known(id); job && has_ended(job->state)) jobs.push_back(*std::move(job));
    return jobs;
}

std::set<std::string> JobStore::uploads_used() const {
    if (table_ != nullptr) return table_->uploads_used();
    const std::lock_guard lock(mutex_);
    std::set<std::string> ids;
    for (const auto& [id, record] : records_) ids.insert({record.job.scene, record.job.paths});
    return ids;
}

JobStore::Counts JobStore::counts() const {
    const std::lock_guard lock(mutex_);
    Counts counts;
    if (table_ != nullptr) {
        counts = {table_->count_by_state(), table_->count_frames()};
        for (const JobState state : all_job_states)
            if (!has_ended(state)) counts.jobs.erase(state);
    }
    for (const auto& [id, record] : records_) {
        if (table_ != nullptr && has_ended(record.job.state)) continue;
        ++counts.jobs[record.job.state];
        if (table_ == nullptr) counts.frames += record.job.frames_done;
    }
    return counts;
}

JobStore::Held JobStore::held() const {
    const std::lock_guard lock(mutex_);
    Held held{records_.size(), 0};
    for (const auto& [id, record] : records_) held.events += record.events->size();
    return held;
}

}  // namespace afterglow
