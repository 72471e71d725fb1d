// What the work on a job has to say of it, as told by JobStore.

#include <algorithm>

#include "service/http/http_message.h"
#include "service/jobs/job_json.h"
#include "service/store/job_store.h"

namespace afterglow {

namespace {

/// The pace so far, kept up. Empty while there is too little to go by.
std::optional<std::chrono::duration<double>> estimate_remaining(const Job& job) {
    if (!job.started || job.progress <= 0) return std::nullopt;
    const std::chrono::duration<double> spent = std::chrono::system_clock::now() - *job.started;
    return std::max(spent, spent.zero()) * ((1 - job.progress) / job.progress);
}

Json progress_json(const Job& job, int frame) {
    return {{"frame", frame},
            {"progress", job.progress},
            {"doing", job.doing},
            {"remaining_s", job.remaining ? Json(job.remaining->count()) : Json(nullptr)}};
}

}  // namespace

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
    if (record->last_progress && time - *record->last_progress < config_.progress_interval) return;
    record->last_progress = time;
    record->events->append(EventKind::progress, dump(progress_json(job, frame)));
}

void JobStore::note_statistics(const std::string& id, const SequenceStatistics& statistics) {
    const std::lock_guard lock(mutex_);
    Record* record = active(id);
    if (record == nullptr) return;
    const SequenceStatistics& before = record->job.statistics;
    const bool tells_more = (statistics.exposure_ev && !before.exposure_ev) ||
                            (statistics.made_for_error && !before.made_for_error);
    record->job.statistics = statistics;
    // Whoever goes on with an edited job after a restart could not find it again.
    if (tells_more) save_or_tell(record->job);
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
        const bool is_stale = record->job.is_stale(info);
        (is_stale ? record->final_frames : record->stale_frames).erase(info.frame);
        (is_stale ? record->stale_frames : record->final_frames).insert(info.frame);
        count_frames(*record);
    }
    record->events->append(info.final ? EventKind::final_image : EventKind::image,
                           dump(image_json(record->job, info)), info.frame);
}

int JobStore::note_strike(const std::string& id, int frame) {
    const std::lock_guard lock(mutex_);
    Record* record = active(id);
    if (record == nullptr) return 0;
    Job& job = record->job;
    job.strikes = job.strike_frame == frame ? job.strikes + 1 : 1;
    job.strike_frame = frame;
    if (table_ != nullptr) table_->set_strikes(id, job.strikes, frame);
    return job.strikes;
}

void JobStore::forget_picture(const std::string& id, int frame) {
    const std::lock_guard lock(mutex_);
    const auto it = records_.find(id);
    if (it == records_.end()) return;
    it->second.final_frames.erase(frame);
    it->second.stale_frames.erase(frame);
    count_frames(it->second);
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
