#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "service/jobs/frame_info.h"
#include "service/jobs/job_json.h"
#include "service/store/frame_journal.h"

namespace afterglow {

/// A picture as it is sent.
struct EncodedPicture {
    std::string png;
    std::string exr;
};

/// Pictures by job, frame and revision, as files in the data folder: JOB/frame_0007.2.png. A stored revision
/// never changes while its frame is being computed. When a frame's final picture is stored all earlier ones
/// are removed. Of jobs at rest nothing is held in memory but what the journal is asked for. Thread-safety:
/// all members; one writer a job.
class FrameStore {
  public:
    /// Makes the folder. With a journal, final pictures become durable and those it knows are there; files
    /// that it does not know are removed. Errors: io.
    explicit FrameStore(std::filesystem::path folder, FrameJournal* journal = nullptr);

    /// Errors: io; the frame's newest revision is then unchanged.
    void put(const std::string& job, const FrameInfo& info, const EncodedPicture& picture);

    /// Waits until every final picture put before is durable, or has failed to become so.
    void flush();
    /// What removing a job would free.
    [[nodiscard]] std::uint64_t bytes_of(const std::string& job) const;
    /// Takes the pictures of a job out of sight, quickly; the folder that now has them, for the caller to
    /// remove. Empty where there are none.
    std::filesystem::path set_aside(const std::string& job);
    /// Removes the pictures of a job.
    void remove(const std::string& job);
    /// Nothing more comes for this job, for now: what is known of it leaves the memory, and pictures that are
    /// not final go. Without a journal nothing happens.
    void rest(const std::string& job);
    /// Of how many jobs the frames are held in memory.
    [[nodiscard]] std::size_t jobs_in_memory() const;

    /// The newest revision of every frame begun, in order of frames.
    [[nodiscard]] std::vector<FrameInfo> newest(const std::string& job) const;
    [[nodiscard]] std::optional<FrameInfo> newest(const std::string& job, int frame) const;

    /// The bytes of a revision; nothing where it is kept no longer or never was. Errors: io.
    [[nodiscard]] std::optional<std::string> read(const std::string& job, int frame, int revision,
                                                  PictureType type) const;

  private:
    [[nodiscard]] std::filesystem::path file_of(const std::string& job, int frame, int revision,
                                                PictureType type) const;
    void remove_earlier(const std::string& job, const FrameInfo& final_info);

    using Frames = std::map<int, FrameInfo>;
    void sweep();
    [[nodiscard]] Frames durable(const std::string& job) const;
    [[nodiscard]] Frames frames_of(const std::string& job) const;
    Frames& loaded(const std::string& job);

    std::filesystem::path folder_;
    FrameJournal* journal_;
    mutable std::mutex mutex_;
    std::map<std::string, Frames> newest_;                           ///< of jobs not at rest
    std::map<std::string, std::map<int, std::set<int>>> revisions_;  ///< stored, by job and frame
    std::uint64_t aside_ = 0;                                        ///< names what is set aside
};

}  // namespace afterglow
