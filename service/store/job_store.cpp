#include "service/store/job_store.h"

#include <utility>

#include "service/base/identity.h"
#include "service/http/http_message.h"
#include "service/jobs/job_json.h"

namespace afterglow {

namespace {

Timestamp now() {
    return std::chrono::system_clock::now();
}

}  // namespace

JobStore::JobStore(JobStoreConfig config, JobTable* table) : config_(std::move(config)), table_(table) {
    if (table_ == nullptr) return;
    for (const JobTable::Entry& entry : table_->unended()) records_.emplace(entry.job.id, restored(entry));
}

void JobStore::count_frames(Record& record) {
    record.job.frames_done = static_cast<int>(record.final_frames.size());
    record.job.stale_frames = static_cast<int>(record.stale_frames.size());
}

void JobStore::save(const Job& job) const {
    if (table_ != nullptr) table_->update(job);
}

/// Changes a job on disk first: where that fails nothing has changed.
void JobStore::take_over(Record& record, Job job) const {
    save(job);
    record.job = std::move(job);
}

/// An end holds even where the disk no longer takes it: after a restart the job then goes on.
void JobStore::save_or_tell(const Job& job) const {
    try {
        save(job);
    } catch (const Error&) {
        static_cast<void>(problem_of(std::current_exception()));  // tells the operator
    }
}

/// The record of a job that may still change, or null. Callers hold the lock.
JobStore::Record* JobStore::active(const std::string& id) {
    const auto it = records_.find(id);
    return it == records_.end() || has_ended(it->second.job.state) ? nullptr : &it->second;
}

Job JobStore::add(Job draft) {
    const std::lock_guard lock(mutex_);
    if (auto repeated = with_key(draft)) return *std::move(repeated);
    do draft.id = random_id();
    while (number_of(draft.id));
    draft.state = JobState::queued;
    draft.created = now();
    Record record;
    record.number = table_ != nullptr ? table_->add(draft) : ++last_number_;
    record.job = draft;
    record.events = std::make_shared<EventLog>(config_.events, config_.first_event);
    record.events->append(EventKind::job, dump(to_json(draft)));
    for (const Warning& warning : draft.warnings)
        record.events->append(EventKind::warning, dump(to_json(warning)));
    records_.emplace(draft.id, std::move(record));
    return draft;
}

std::stop_token JobStore::stop_token(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto it = records_.find(id);
    return it == records_.end() ? std::stop_token() : it->second.stop.get_token();
}

bool JobStore::start(const std::string& id) {
    const std::lock_guard lock(mutex_);
    Record* record = active(id);
    if (record == nullptr || !may_follow(record->job.state, JobState::running)) return false;
    Job job = record->job;
    job.state = JobState::running;
    if (!job.started) job.started = now();
    take_over(*record, std::move(job));
    record->events->append(EventKind::job, dump(to_json(record->job)));
    return true;
}

bool JobStore::pause(const std::string& id) {
    std::stop_source stop(std::nostopstate);
    {
        const std::lock_guard lock(mutex_);
        Record* record = active(id);
        if (record == nullptr || !may_follow(record->job.state, JobState::paused)) return false;
        Job job = record->job;
        job.state = JobState::paused;
        job.doing.clear();
        job.remaining.reset();
        take_over(*record, std::move(job));
        record->events->append(EventKind::job, dump(to_json(record->job)));
        stop = record->stop;
    }
    stop.request_stop();
    return true;
}

bool JobStore::requeue(const std::string& id) {
    const std::lock_guard lock(mutex_);
    Record* recalled = recall(id);
    if (recalled == nullptr || !may_follow(recalled->job.state, JobState::queued)) return false;
    Record& record = *recalled;
    Job job = record.job;
    job.state = JobState::queued;
    job.ended.reset();
    job.error.reset();
    job.strikes = 0;
    job.frames_removed.reset();
    job.progress = static_cast<double>(job.frames_done) / job.frame_count();
    if (table_ != nullptr) table_->set_strikes(id, 0, 0);
    take_over(record, std::move(job));
    record.stop = std::stop_source();
    record.events->reopen();
    record.events->append(EventKind::job, dump(to_json(record.job)));
    return true;
}

JobStore::EditResult JobStore::edit(const std::string& id, int revision, JobEdit edit) {
    std::stop_source stop(std::nostopstate);
    {
        const std::lock_guard lock(mutex_);
        Record* recalled = recall(id);
        if (recalled == nullptr || !may_be_edited(recalled->job.state)) return EditResult::illegal;
        Record& record = *recalled;
        if (record.job.revision() != revision) return EditResult::stale;
        Job job = record.job;
        const bool had_ended = has_ended(job.state);
        if (had_ended) job.state = JobState::queued;
        job.ended.reset();
        job.error.reset();
        job.frames_removed.reset();
        const int first = edit.first_frame;
        job.edits.push_back(std::move(edit));
        if (table_ != nullptr) table_->add_edit(job);
        record.job = std::move(job);
        const auto changed = record.final_frames.lower_bound(first);
        record.stale_frames.insert(changed, record.final_frames.end());
        record.final_frames.erase(changed, record.final_frames.end());
        count_frames(record);
        record.job.progress = static_cast<double>(record.job.frames_done) / record.job.frame_count();
        if (had_ended) record.events->reopen();
        const std::optional<double>& reused = record.job.edits.back().reused;
        record.events->append(EventKind::edit, dump({{"revision", record.job.revision()},
                                                     {"first_frame", first},
                                                     {"reused", reused ? Json(*reused) : Json(nullptr)}}));
        record.events->append(EventKind::job, dump(to_json(record.job)));
        stop = std::exchange(record.stop, std::stop_source());
    }
    stop.request_stop();
    return EditResult::accepted;
}

void JobStore::note_reused(const std::string& id, int revision, double share) {
    const std::lock_guard lock(mutex_);
    Record* record = active(id);
    if (record == nullptr || revision < 1 || revision > record->job.revision()) return;
    std::optional<double>& reused = record->job.edits[static_cast<std::size_t>(revision) - 1].reused;
    if (reused) return;
    reused = share;
    try {
        if (table_ != nullptr) table_->update_reused(record->job, revision);
    } catch (const Error&) {
        static_cast<void>(problem_of(std::current_exception()));  // a figure alone: the operator is told
    }
    record->events->append(EventKind::reused, dump({{"revision", revision}, {"reused", share}}));
}

bool JobStore::set_priority(const std::string& id, int priority) {
    const std::lock_guard lock(mutex_);
    Record* record = active(id);
    if (record == nullptr) return false;
    Job job = record->job;
    job.priority = priority;
    take_over(*record, std::move(job));
    record->events->append(EventKind::job, dump(to_json(record->job)));
    return true;
}

void JobStore::interrupt(const std::string& id) const {
    std::stop_source stop(std::nostopstate);
    {
        const std::lock_guard lock(mutex_);
        const auto it = records_.find(id);
        if (it != records_.end()) stop = it->second.stop;
    }
    stop.request_stop();
}

bool JobStore::remove(const std::string& id) {
    const std::lock_guard lock(mutex_);
    const auto job = known(id);
    if (!job || !has_ended(job->state)) return false;
    if (table_ != nullptr) table_->remove(id);
    const auto it = records_.find(id);
    if (it == records_.end()) return true;
    it->second.events->close();
    records_.erase(it);
    return true;
}

bool JobStore::forget_frames(const std::string& id, Timestamp time, const std::function<void()>& remove) {
    const std::lock_guard lock(mutex_);
    Record* recalled = recall(id);
    if (recalled == nullptr || !has_ended(recalled->job.state)) return false;
    Record& record = *recalled;
    Job job = record.job;
    job.frames_removed = time;
    if (table_ != nullptr) table_->forget_frames(job);
    record.job = std::move(job);
    record.final_frames.clear();
    record.stale_frames.clear();
    count_frames(record);
    record.events->forget();
    remove();
    put_to_rest();
    return true;
}

void JobStore::close_streams() {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, record] : records_) record.events->close();
}

bool JobStore::end(const std::string& id, JobState state, const std::optional<Problem>& error) {
    return end_if(id, state, error, [](const Job&) { return true; });
}

bool JobStore::succeed(const std::string& id, int revision) {
    return end_if(id, JobState::succeeded, std::nullopt,
                  [revision](const Job& job) { return job.revision() == revision; });
}

bool JobStore::end_if(const std::string& id, JobState state, const std::optional<Problem>& error,
                      const std::function<bool(const Job&)>& condition) {
    std::stop_source stop(std::nostopstate);
    {
        const std::lock_guard lock(mutex_);
        Record* record = active(id);
        if (record == nullptr || !has_ended(state) || !may_follow(record->job.state, state)) return false;
        if (!condition(record->job)) return false;
        Job& job = record->job;
        job.state = state;
        job.ended = now();
        job.error = error;
        job.doing.clear();
        job.remaining.reset();
        if (state == JobState::succeeded) job.progress = 1;
        save_or_tell(job);
        if (error) record->events->append(EventKind::error, dump(to_json(*error)));
        record->events->append(EventKind::job, dump(to_json(job)));
        record->events->append(EventKind::end, dump({{"state", name_of(state)}}));
        record->ended = ++ends_;
        stop = record->stop;
        put_to_rest();
    }
    // Outside the lock, since whoever is told of the stop may ask for the job.
    stop.request_stop();
    return true;
}

}  // namespace afterglow
