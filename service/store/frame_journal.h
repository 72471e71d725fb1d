#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "service/jobs/frame_info.h"
#include "service/store/database.h"

namespace afterglow {

/// The durable frames of a job, in order.
std::vector<FrameInfo> durable_frames(Database& database, const std::string& job);

/// Makes final pictures durable in groups: their files first, then a row each, all of a group in one commit.
/// A picture without a row is as if it had never been. Thread-safety: all members.
class FrameJournal {
  public:
    struct Entry {
        std::string job;
        FrameInfo info;
        std::vector<std::filesystem::path> files;
    };
    /// Told from the journal's thread for each picture of a group that could not be made durable.
    using OnFailure = std::function<void(const Entry& entry, std::exception_ptr failure)>;

    /// `longest`: how long an entry waits for others.
    FrameJournal(Database& database, OnFailure on_failure,
                 std::chrono::milliseconds longest = std::chrono::milliseconds(200));
    /// Commits what waits.
    ~FrameJournal();
    FrameJournal(const FrameJournal&) = delete;
    FrameJournal& operator=(const FrameJournal&) = delete;

    void add(Entry entry);
    /// Waits until everything added before is durable or has failed.
    void flush();
    /// The durable frames of a job, in order.
    std::vector<FrameInfo> frames_of(const std::string& job) { return durable_frames(database_, job); }

  private:
    void loop();
    void commit(const std::vector<Entry>& group);

    Database& database_;
    std::chrono::milliseconds longest_;
    OnFailure on_failure_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Entry> waiting_;
    std::uint64_t added_ = 0;
    std::uint64_t done_ = 0;
    bool hurry_ = false;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace afterglow
