#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "service/http/http_message.h"
#include "service/jobs/event_log.h"
#include "service/store/frame_store.h"

namespace afterglow {

/// The content type of a LiveStream.
inline constexpr const char* live_content_type = "multipart/x-mixed-replace; boundary=picture";

/// The newest picture of a job, again and again, as a browser's <img> shows it: whatever came while the
/// reader was busy is skipped. Ends with the job.
class LiveStream : public ReplyStream {
  public:
    /// `wait`: longest wait in `next`. The store must outlive the stream.
    LiveStream(std::string job, std::shared_ptr<const EventLog> log, const FrameStore& frames,
               std::chrono::milliseconds wait = std::chrono::milliseconds(500));
    Piece next() override;

  private:
    [[nodiscard]] std::string picture(int frame) const;

    std::string job_;
    std::shared_ptr<const EventLog> log_;
    const FrameStore& frames_;
    std::chrono::milliseconds wait_;
    std::uint64_t reached_ = 0;
    bool has_begun_ = false;
};

}  // namespace afterglow
