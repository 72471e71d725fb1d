#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "service/jobs/frame_info.h"
#include "service/jobs/job_json.h"

namespace afterglow {

/// A picture as it is sent.
struct EncodedPicture {
    std::string png;
    std::string exr;
};

/// Pictures by job, frame and revision, as files in the data folder: JOB/frame_0007.2.png. A stored revision
/// never changes. When a frame's final picture is stored its preliminary ones are removed. Thread-safety: all
/// members; one writer a job.
class FrameStore {
  public:
    /// Makes the folder. Errors: io.
    explicit FrameStore(std::filesystem::path folder);

    /// Errors: io; the frame's newest revision is then unchanged.
    void put(const std::string& job, const FrameInfo& info, const EncodedPicture& picture);

    /// The newest revision of every frame begun, in order of frames.
    [[nodiscard]] std::vector<FrameInfo> newest(const std::string& job) const;
    [[nodiscard]] std::optional<FrameInfo> newest(const std::string& job, int frame) const;

    /// The bytes of a revision; nothing where it is kept no longer or never was. Errors: io.
    [[nodiscard]] std::optional<std::string> read(const std::string& job, int frame, int revision,
                                                  PictureType type) const;

  private:
    [[nodiscard]] std::filesystem::path file_of(const std::string& job, int frame, int revision,
                                                PictureType type) const;
    void remove_preliminary(const std::string& job, const FrameInfo& final_info) const;

    std::filesystem::path folder_;
    mutable std::mutex mutex_;
    std::map<std::string, std::map<int, FrameInfo>> newest_;
};

}  // namespace afterglow
