#include "service/store/frame_journal.h"

#include <utility>

#include "service/store/durable_file.h"

namespace afterglow {

FrameJournal::FrameJournal(Database& database, OnFailure on_failure, std::chrono::milliseconds longest)
    : database_(database),
      longest_(longest),
      on_failure_(std::move(on_failure)),
      thread_([this] { loop(); }) {}

FrameJournal::~FrameJournal() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void FrameJournal::add(Entry entry) {
    {
        const std::lock_guard lock(mutex_);
        waiting_.push_back(std::move(entry));
        ++added_;
    }
    changed_.notify_all();
}

void FrameJournal::flush() {
    std::unique_lock lock(mutex_);
    const auto until = added_;
    hurry_ = true;
    changed_.notify_all();
    changed_.wait(lock, [&] { return done_ >= until; });
}

std::vector<FrameInfo> durable_frames(Database& database, const std::string& job) {
    std::vector<FrameInfo> frames;
    for (const Row& row :
         database.ask("SELECT frame, revision, residual, error_bound, picture_error, seconds, "
                      "job_revision FROM frames WHERE job = ?1 ORDER BY frame",
                      {job})) {
        FrameInfo info{static_cast<int>(as_integer(row[0])),
                       static_cast<int>(as_integer(row[1])),
                       true,
                       as_real(row[2]).value_or(0),
                       as_real(row[3]),
                       as_real(row[4])};
        info.seconds = as_real(row[5]).value_or(0);
        info.job_revision = static_cast<int>(as_integer(row[6]));
        frames.push_back(info);
    }
    return frames;
}

void FrameJournal::loop() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        // The first one waits for others to share its synchronisation.
        changed_.wait_for(lock, longest_, [&] { return stopping_ || hurry_; });
        hurry_ = false;
        const std::vector<Entry> group = std::exchange(waiting_, {});
        lock.unlock();
        commit(group);
        lock.lock();
        done_ += group.size();
        changed_.notify_all();
    }
}

void FrameJournal::commit(const std::vector<Entry>& group) {
    try {
        std::vector<std::filesystem::path> files;
        for (const Entry& entry : group) files.insert(files.end(), entry.files.begin(), entry.files.end());
        make_durable(files);
        database_.together([&] {
            for (const auto& [job, info, unused] : group)
                database_.change("INSERT OR REPLACE INTO frames VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
                                 {job, std::int64_t{info.frame}, std::int64_t{info.revision}, info.residual,
                                  cell_of(info.error_bound), cell_of(info.picture_error), info.seconds,
                                  std::int64_t{info.job_revision}});
        });
    } catch (...) {
        for (const Entry& entry : group) on_failure_(entry, std::current_exception());
    }
}

}  // namespace afterglow
