#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "service/jobs/frame_info.h"
#include "service/store/frame_store.h"
#include "solver/sequence/sequence.h"

namespace afterglow {

/// A picture waiting to be encoded.
struct PictureTask {
    /// Whether a newer revision of the same frame may take its place while it waits. Final pictures always
    /// stay.
    enum class Keep { always, until_superseded };
    std::string job;
    Revision revision;
    std::optional<double> error_bound;  ///< of final pictures
    Keep keep = Keep::until_superseded;
    double seconds = 0;    ///< that the frame took, of final pictures
    int job_revision = 0;  ///< of the job that it shows
};

/// Who is told about what became of a picture; called from the encoder's thread.
struct EncoderEvents {
    std::function<void(const std::string& job, const FrameInfo& info)> stored;
    std::function<void(const std::string& job, std::exception_ptr failure)> failed;
};

struct EncoderConfig {
    std::size_t max_waiting = 8;  ///< pictures that must be kept; `submit` waits while there are more
};

/// Encodes and stores pictures on a thread of its own, in the order of submission, so that the solver can go
/// on. Memory is bounded: of each frame at most one picture waits that may be superseded, and the others are
/// counted. Thread-safety: all members.
class Encoder {
  public:
    Encoder(FrameStore& frames, EncoderEvents events, EncoderConfig config = {});
    /// Encodes what waits, then stops.
    ~Encoder();
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    /// Waits only while too many pictures that must be kept are waiting.
    void submit(PictureTask task);
    /// Calls `action` from the encoder's thread once everything submitted before has been stored and is
    /// durable.
    void after_pictures(std::function<void()> action);
    /// Forgets the waiting pictures of a job.
    void forget(const std::string& job);

  private:
    struct Item {
        PictureTask task;
        std::function<void()> action;  ///< instead of a picture where set
    };
    void loop();
    void store(const PictureTask& task);
    [[nodiscard]] std::size_t kept_waiting() const;

    FrameStore& frames_;
    EncoderEvents events_;
    EncoderConfig config_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Item> items_;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace afterglow
