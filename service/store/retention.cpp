#include "service/store/retention.h"

#include <algorithm>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "service/base/problem.h"

namespace afterglow {

namespace fs = std::filesystem;

/// Something that may go as a whole.
struct Retention::Item {
    Timestamp since;  ///< when it was finished
    std::uint64_t bytes = 0;
    std::string job = {};                       ///< whose pictures
    fs::path file = {};                         ///< or a cached file
    std::optional<BlobStore::Entry> blob = {};  ///< or a blob
};

Retention::Retention(JobStore& jobs, FrameStore& frames, SceneStore& scenes, BlobStore& blobs,
                     fs::path cache_folder, const RetentionConfig& config, Clock now)
    : jobs_(jobs),
      frames_(frames),
      scenes_(scenes),
      blobs_(blobs),
      cache_folder_(std::move(cache_folder)),
      config_(config),
      now_(std::move(now)) {
    if (config_.keep_for || config_.keep_at_most || config_.keep_uploads_for)
        thread_ = std::thread([this] { loop(); });
}

Retention::~Retention() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void Retention::loop() {
    std::unique_lock lock(mutex_);
    do {
        lock.unlock();
        try {
            tidy();
        } catch (...) {
            static_cast<void>(problem_of(std::current_exception()));  // tells the operator
        }
        lock.lock();
    } while (!changed_.wait_for(lock, config_.interval, [&] { return stopping_; }));
}

void Retention::tidy() {
    const std::vector<Item> items = oldest_first();
    std::uint64_t kept = 0;
    for (const Item& item : items) kept += item.bytes;
    for (const Job& job : jobs_.unended()) kept += frames_.bytes_of(job.id);
    for (const Item& item : items) {
        const bool is_old = config_.keep_for && now_() - item.since > *config_.keep_for;
        const bool is_too_much = config_.keep_at_most && kept > *config_.keep_at_most;
        // What comes later is younger and leaves as much.
        if (!is_old && !is_too_much) break;
        remove(item);
        kept -= item.bytes;
    }
    if (config_.keep_uploads_for) remove_unused_uploads();
}

void Retention::remove_unused_uploads() {
    // Listed before the jobs: what is asked for in between is younger than listed, and stays.
    const std::vector<SceneStore::Entry> uploads = scenes_.list();
    const std::set<std::string> used = jobs_.uploads_used();
    for (const SceneStore::Entry& upload : uploads)
        if (now_() - upload.asked > *config_.keep_uploads_for && !used.contains(upload.id))
            scenes_.remove(upload);
}

std::vector<Retention::Item> Retention::oldest_first() const {
    std::vector<Item> items;
    for (const Job& job : jobs_.ended_with_frames())
        if (job.ended) items.push_back({*job.ended, frames_.bytes_of(job.id), job.id});
    for (const BlobStore::Entry& blob : blobs_.list())
        items.push_back({blob.asked, blob.bytes, {}, {}, blob});
    std::error_code error;
    for (fs::recursive_directory_iterator it(cache_folder_, error), end; it != end && !error;
         it.increment(error)) {
        if (!it->is_regular_file(error)) continue;
        const auto written = std::chrono::file_clock::to_sys(it->last_write_time(error));
        items.push_back({std::chrono::time_point_cast<Timestamp::duration>(written), it->file_size(error), "",
                         it->path()});
    }
    std::stable_sort(items.begin(), items.end(),
                     [](const Item& a, const Item& b) { return a.since < b.since; });
    return items;
}

void Retention::remove(const Item& item) {
    std::error_code ignored;  // what is gone already is as good as removed
    if (item.blob) {
        blobs_.remove(*item.blob);
        return;
    }
    if (item.job.empty()) {
        fs::remove(item.file, ignored);
        return;
    }
    frames_.flush();
    fs::path aside;
    jobs_.forget_frames(item.job, now_(), [&] { aside = frames_.set_aside(item.job); });
    if (!aside.empty()) fs::remove_all(aside, ignored);
}

}  // namespace afterglow
