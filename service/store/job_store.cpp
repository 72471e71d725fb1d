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

JobStore::JobStore(JobStoreConfig config) : config_(config) {}

/// The record of a job that may still change, or null. Callers hold the lock.
JobStore::Record* JobStore::active(const std::string& id) {
    const auto it = records_.find(id);
    return it == records_.end() || has_ended(it->second.job.state) ? nullptr : &it->second;
}

Job JobStore::add(Job draft) {
    const std::lock_guard lock(mutex_);
    do draft.id = random_id();
    while (records_.contains(draft.id));
    draft.state = JobState::queued;
    draft.created = now();
    Record record{draft, std::make_shared<EventLog>(config_.events), std::stop_source(), {}};
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
    record->job.state = JobState::running;
    record->job.started = now();
    record->events->append(EventKind::job, dump(to_json(record->job)));
    return true;
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
    if (info.final) ++record->job.frames_done;
    record->events->append(info.final ? EventKind::final_image : EventKind::image, dump(image_json(id, info)),
                           info.frame);
}

}  // namespace afterglow
