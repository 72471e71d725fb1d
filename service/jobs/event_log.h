#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace afterglow {

/// What an event of a job tells.
enum class EventKind { job, progress, image, final_image, edit, reused, warning, error, end };

/// The name clients know it by; both kinds of image are "image".
std::string_view name_of(EventKind kind);

struct Event {
    std::uint64_t id = 0;  ///< increasing within its job, from 1; gaps are events that were superseded
    EventKind kind = EventKind::job;
    int frame = -1;    ///< of images; -1: none
    std::string data;  ///< JSON
};

struct EventLogConfig {
    std::size_t capacity = 20'000;  ///< events kept; about 300 bytes each
    std::size_t batch = 256;        ///< events handed to a reader at a time
};

/// The events of one job, for any number of readers at their own pace. Readers hold nothing but the id they
/// have reached, so a slow one costs nothing. Only the newest progress is kept. When the log is full,
/// preliminary images of finished frames go first, oldest first; then the oldest event of all, after which
/// readers that had not seen it are told so. Thread-safety: all members.
class EventLog {
  public:
    /// `first`: ids begin after it.
    explicit EventLog(EventLogConfig config = {}, std::uint64_t first = 0);
    /// One that `kept` has written, as it was. Errors: invalid_input for other text.
    EventLog(EventLogConfig config, const std::string& kept);
    /// The log as text, without progress and without the preliminary images of finished frames.
    [[nodiscard]] std::string kept() const;

    /// Adds an event; EventKind::end closes the log. After that nothing is added.
    void append(EventKind kind, std::string data, int frame = -1);
    /// Lets every reader finish, whether or not the job has ended.
    void close();
    /// Goes on after an end, for a job that is tried again.
    void reopen();
    /// Drops all events but the last one where the log has ended: readers before it are told too_old.
    void forget();

    enum class Status {
        open,     ///< more may come
        ended,    ///< nothing will ever come after `id`
        too_old,  ///< events after `id` are kept no longer
    };
    enum class Fill { partial, full };  ///< full: as many events as a batch holds
    struct Batch {
        Status status = Status::open;
        Fill fill = Fill::partial;
        std::vector<Event> events;  ///< in order of their ids
    };
    /// What came after `id`, at once, or after at most `timeout` if there is nothing yet.
    [[nodiscard]] Batch wait_after(std::uint64_t id, std::chrono::milliseconds timeout) const;

    /// The id of the newest event ever added; 0: none.
    [[nodiscard]] std::uint64_t last_id() const;
    /// The `end` event, once there is one.
    [[nodiscard]] std::optional<Event> end() const;
    /// How many events are held.
    [[nodiscard]] std::size_t size() const;

  private:
    void supersede(std::uint64_t id, EventKind kind, int frame);
    void make_room();

    EventLogConfig config_;
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::map<std::uint64_t, Event> events_;
    std::map<int, std::vector<std::uint64_t>> preliminary_;  ///< images of frames that are not final yet
    std::deque<std::uint64_t> superseded_;                   ///< images that may go when room is needed
    std::uint64_t last_id_ = 0;
    std::uint64_t progress_id_ = 0;
    std::uint64_t lost_id_ = 0;  ///< newest event dropped that readers had a right to
    bool closed_ = false;
};

}  // namespace afterglow
