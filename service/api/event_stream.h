#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "service/http/http_message.h"
#include "service/jobs/event_log.h"

namespace afterglow {

/// One event as `text/event-stream` (HTML Living Standard, §9.2).
std::string sse_text(std::uint64_t id, std::string_view name, std::string_view data);

/// One event as a line of JSON, `{"event","id","data"}`.
std::string ndjson_text(std::uint64_t id, std::string_view name, std::string_view data);

/// How a stream of events is written.
struct EventFormat {
    const char* content_type;
    std::string (*text)(std::uint64_t id, std::string_view name, std::string_view data);
    const char* opening;    ///< sent at once, so that the reader knows that it is connected
    const char* heartbeat;  ///< sent when nothing has happened for long; no event
};
/// Server-sent events, or lines of JSON between which empty ones may stand.
extern const EventFormat sse_format;
extern const EventFormat ndjson_format;
/// The one that an Accept header asks for: lines where it names application/x-ndjson and not
/// text/event-stream. Thread-safety: pure; any text is allowed.
const EventFormat& format_accepted(std::string_view accept);

/// Leaves out images that a later image of the same frame in the list makes superfluous; final ones stay.
std::vector<Event> without_superseded(std::vector<Event> events);

struct EventStreamConfig {
    std::chrono::milliseconds wait{500};      ///< longest wait in `next`
    std::chrono::seconds heartbeat{10};       ///< a sign of life is sent after this long without an event
    const EventFormat* format = &sse_format;  ///< never null
};

/// A reader of a job's events. It sends all there is; once it has been up to date and then falls behind by a
/// whole batch, it leaves superseded images out. It ends when the log has ended, or can no longer be
/// followed.
class EventStream : public ReplyStream {
  public:
    /// Sends `opening`, then what came after the event `after`.
    EventStream(std::shared_ptr<const EventLog> log, std::uint64_t after, std::string opening,
                EventStreamConfig config = {});
    Piece next() override;

  private:
    using Clock = std::chrono::steady_clock;
    std::shared_ptr<const EventLog> log_;
    std::uint64_t reached_;
    std::string opening_;
    EventStreamConfig config_;
    Clock::time_point last_sent_ = Clock::now();
    bool was_up_to_date_ = false;
};

}  // namespace afterglow
