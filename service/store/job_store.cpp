#include "service/store/job_store.h"

#include <algorithm>
#include <utility>

#include "service/base/identity.h"
#include "service/http/http_message.h"
#include "service/jobs/job_json.h"

namespace afterglow {

namespace {

Timestamp now() {
    return std::chrono::system_clock::now();
}

/// The pace so far, kept up. Empty while there is too little to go by.
std::optional<std::chrono::duration<double>> estimate_remaining(const Job& job) {
    if (!job.started || job.progress <= 0) return std::nullopt;
    const std::chrono::duration<double> spent = now() - *job.started;
    return std::max(spent, spent.zero()) * ((1 - job.progress) / job.progress);
}

Json progress_json(const Job& job, int frame) {
    return {{"frame", frame},
            {"progress", job.progress},
            {"doing", job.doing},
            {"remaining_s", job.remaining ? Json(job.remaining->count()) : Json(nullptr)}};
}

}  // namespace

JobStore::JobStore(JobStoreConfig config, JobTable* table,
                   const std::map<std::string, std::vector<FrameInfo>>& frames)
    : config_(config), table_(table) {
    if (table_ == nullptr) return;
    for (const Job& job : table_->load()) {
        const auto known = frames.find(job.id);
        restore(job, known == frames.end() ? std::vector<FrameInfo>() : known->second);
    }
}

/// Readers who had reached an id of an earlier life get the job as it stands from the beginning.
void JobStore::restore(const Job& job, const std::vector<FrameInfo>& frames) {
    Record record{
        job, std::make_shared<EventLog>(config_.events, config_.first_event), std::stop_source(), {}};
    Job& restored = record.job;
    for (const FrameInfo& info : frames) record.final_frames.insert(info.frame);
    restored.frames_done = static_cast<int>(record.final_frames.size());
    restored.progress = static_cast<double>(restored.frames_done) / restored.frame_count();
    EventLog& log = *record.events;
    log.append(EventKind::job, dump(to_json(restored)));
    for (const Warning& warning : job.warnings) log.append(EventKind::warning, dump(to_json(warning)));
    for (const FrameInfo& info : frames)
        log.append(EventKind::final_image, dump(image_json(job.id, info)), info.frame);
    if (job.error) log.append(EventKind::error, dump(to_json(*job.error)));
    if (has_ended(job.state)) {
        log.append(EventKind::end, dump({{"state", name_of(job.state)}}));
        record.stop.request_stop();
    }
    order_.push_back(job.id);
    records_.emplace(job.id, std::move(record));
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

/// The job that this draft repeats, or null. Callers hold the lock.
const Job* JobStore::with_key(const Job& draft) const {
    if (draft.idempotency_key.empty()) return nullptr;
    for (const auto& [id, record] : records_) {
        const Job& job = record.job;
        if (job.owner != draft.owner || job.idempotency_key != draft.idempotency_key) continue;
        if (job.idempotency_hash == draft.idempotency_hash) return &job;
        throw ProblemError(
            {422, "idempotency_key_reused", "this key came with another request before", "Idempotency-Key"});
    }
    return nullptr;
}

/// The record of a job that may still change, or null. Callers hold the lock.
JobStore::Record* JobStore::active(const std::string& id) {
    const auto it = records_.find(id);
    return it == records_.end() || has_ended(it->second.job.state) ? nullptr : &it->second;
}

std::optional<Job> JobStore::repeated(const Job& draft) const {
    const std::lock_guard lock(mutex_);
    const Job* known = with_key(draft);
    return known == nullptr ? std::nullopt : std::optional(*known);
}

Job JobStore::add(Job draft) {
    const std::lock_guard lock(mutex_);
    if (const Job* known = with_key(draft)) return *known;
    do draft.id = random_id();
    while (records_.contains(draft.id));
    draft.state = JobState::queued;
    draft.created = now();
    if (table_ != nullptr) table_->add(draft);
    Record record{
        draft, std::make_shared<EventLog>(config_.events, config_.first_event), std::stop_source(), {}};
    record.events->append(EventKind::job, dump(to_json(draft)));
    for (const Warning& warning : draft.warnings)
        record.events->append(EventKind::warning, dump(to_json(warning)));
    order_.push_back(draft.id);
    records_.emplace(draft.id, std::move(record));
    return draft;
}

std::optional<Job> JobStore::find(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto it = records_.find(id);
    if (it == records_.end()) return std::nullopt;
    return it->second.job;
}

std::vector<Job> JobStore::list() const {
    const std::lock_guard lock(mutex_);
    std::vector<Job> jobs;
    for (auto id = order_.rbegin(); id != order_.rend(); ++id) jobs.push_back(records_.at(*id).job);
    return jobs;
}

std::shared_ptr<const EventLog> JobStore::events(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto it = records_.find(id);
    return it == records_.end() ? nullptr : it->second.events;
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
    const auto it = records_.find(id);
    if (it == records_.end() || !may_follow(it->second.job.state, JobState::queued)) return false;
    Record& record = it->second;
    Job job = record.job;
    job.state = JobState::queued;
    job.ended.reset();
    job.error.reset();
    job.progress = static_cast<double>(job.frames_done) / job.frame_count();
    take_over(record, std::move(job));
    record.stop = std::stop_source();
    record.events->reopen();
    record.events->append(EventKind::job, dump(to_json(record.job)));
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
    const auto it = records_.find(id);
    if (it == records_.end() || !has_ended(it->second.job.state)) return false;
    if (table_ != nullptr) table_->remove(id);
    it->second.events->close();
    records_.erase(it);
    std::erase(order_, id);
    return true;
}

void JobStore::close_streams() {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, record] : records_) record.events->close();
}

bool JobStore::end(const std::string& id, JobState state, const std::optional<Problem>& error) {
    std::stop_source stop(std::nostopstate);
    {
        const std::lock_guard lock(mutex_);
        Record* record = active(id);
        if (record == nullptr || !has_ended(state) || !may_follow(record->job.state, state)) return false;
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
        stop = record->stop;
    }
    // Outside the lock, since whoever is told of the stop may ask for the job.
    stop.request_stop();
    return true;
}

void JobStore::note_progress(const std::string& id, int frame, int frames_before, const Progress& progress) {
    const auto time = std::chrono::steady_clock::now();
    const std::lock_guard lock(mutex_);
    Record* record = active(id);
    if (record == nullptr) return;
    Job& job = record->job;
    const double whole = (frames_before + std::clamp(progress.fraction, 0.0, 1.0)) / job.frame_count();
    job.progress = std::max(job.progress, std::min(whole, 1.0));
    job.doing = progress.doing;
    job.remaining = estimate_remaining(job);
    if (time - record->last_progress < config_.progress_interval) return;
    record->last_progress = time;
    record->events->append(EventKind::progress, dump(progress_json(job, frame)));
}

void JobStore::note_statistics(const std::string& id, const SequenceStatistics& statistics) {
    const std::lock_guard lock(mutex_);
    if (Record* record = active(id)) record->job.statistics = statistics;
}

void JobStore::note_warnings(const std::string& id, const Warnings& warnings) {
    const std::lock_guard lock(mutex_);
    Record* record = active(id);
    if (record == nullptr) return;
    for (const Warning& warning : warnings) {
        Warnings& known = record->job.warnings;
        const bool is_known = std::any_of(known.begin(), known.end(), [&](const Warning& w) {
            return w.place == warning.place && w.message == warning.message;
        });
        if (is_known) continue;
        known.push_back(warning);
        record->events->append(EventKind::warning, dump(to_json(warning)));
    }
}

void JobStore::note_picture(const std::string& id, const FrameInfo& info) {
    const std::lock_guard lock(mutex_);
    Record* record = active(id);
    if (record == nullptr) return;
    if (info.final) {
        record->final_frames.insert(info.frame);
        record->job.frames_done = static_cast<int>(record->final_frames.size());
    }
    record->events->append(info.final ? EventKind::final_image : EventKind::image, dump(image_json(id, info)),
                           info.frame);
}

void JobStore::forget_picture(const std::string& id, int frame) {
    const std::lock_guard lock(mutex_);
    const auto it = records_.find(id);
    if (it == records_.end()) return;
    it->second.final_frames.erase(frame);
    it->second.job.frames_done = static_cast<int>(it->second.final_frames.size());
}

int JobStore::first_unfinished(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto it = records_.find(id);
    if (it == records_.end()) return 0;
    int frame = it->second.job.frames.first;
    while (it->second.final_frames.contains(frame)) ++frame;
    return frame;
}

}  // namespace afterglow
