#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "service/base/timestamp.h"
#include "service/store/blob_store.h"
#include "service/store/frame_store.h"
#include "service/store/job_store.h"
#include "service/store/scene_store.h"

namespace afterglow {

struct RetentionConfig {
    /// Pictures and events go this long after their job's end, cached rows this long after they were written,
    /// blobs this long after they were last asked for. Nothing: never.
    std::optional<std::chrono::seconds> keep_for;
    /// Bytes of pictures, cached rows and blobs together, above which the oldest of all go. Nothing: any
    /// number.
    std::optional<std::uint64_t> keep_at_most;
    /// Scenes and paths that no job has go this long after they were last uploaded or a job was submitted
    /// with them. Longer than a submission may take, which looks for them before there is a job. Nothing:
    /// never.
    std::optional<std::chrono::seconds> keep_uploads_for;
    std::chrono::milliseconds interval{60'000};  ///< between two looks
};

/// Removes what has become too old or too much: pictures of jobs that have ended, with their events, cached
/// rows, and blobs, of which scenes have copies; the oldest first; never anything of a job that may go on by
/// itself. The jobs stay and say so. Scenes and paths go with age once no job has them. Thread-safety: all
/// members.
class Retention {
  public:
    using Clock = std::function<Timestamp()>;
    /// Looks at once, then now and then, where a limit is set. `cache_folder`: its files are cached rows.
    /// What is given must outlive this object.
    Retention(JobStore& jobs, FrameStore& frames, SceneStore& scenes, BlobStore& blobs,
              std::filesystem::path cache_folder, const RetentionConfig& config,
              Clock now = std::chrono::system_clock::now);
    ~Retention();
    Retention(const Retention&) = delete;
    Retention& operator=(const Retention&) = delete;

    /// Looks once. Errors: StorageError.
    void tidy();

  private:
    struct Item;
    void loop();
    [[nodiscard]] std::vector<Item> oldest_first() const;
    void remove(const Item& item);
    void remove_unused_uploads();

    JobStore& jobs_;
    FrameStore& frames_;
    SceneStore& scenes_;
    BlobStore& blobs_;
    std::filesystem::path cache_folder_;
    RetentionConfig config_;
    Clock now_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace afterglow
