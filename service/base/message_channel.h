#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "solver/base/json.h"

namespace afterglow {

/// What parent and child say to each other.
enum class MessageKind : std::uint32_t {
    survey,    ///< to the child: look at a scene (the whole conversation)
    unpack,    ///< to the child: unpack an archive (likewise)
    start,     ///< to the child: prepare a job
    step,      ///< to the child: compute a frame of it
    edit,      ///< to the child: take over an edit of it
    stop,      ///< to the child: give up what was asked for last, if it is not done
    progress,  ///< how far that is
    revision,  ///< a picture
    done,      ///< what was asked for, with its result
    failed,    ///< what was asked for cannot be had, see `failure`
};

/// A kind, some values, and bytes that need no coding.
struct Message {
    MessageKind kind = MessageKind::done;
    Json values;
    std::string bytes = {};
};

/// The other side has closed, or has ended.
class ChannelClosed : public std::runtime_error {
  public:
    ChannelClosed() : std::runtime_error("the other process is gone") {}
};
/// The other side took longer than it may.
class ChannelTimeout : public std::runtime_error {
  public:
    ChannelTimeout() : std::runtime_error("the other process took too long") {}
};

/// Whole messages over a connected stream socket: kind and two lengths, the values as CBOR (numbers keep
/// their bits), the bytes. Does not own the socket. Errors: ChannelClosed; ChannelTimeout past `until`; what
/// is no message, or longer than 4 GiB, counts as closed. Thread-safety: one thread sends, one receives.
class MessageChannel {
  public:
    using Clock = std::chrono::steady_clock;
    explicit MessageChannel(int socket) : socket_(socket) {}

    void send(const Message& message) const;
    /// `until`: nothing: as long as it takes.
    [[nodiscard]] Message receive(std::optional<Clock::time_point> until = std::nullopt) const;

  private:
    void write(std::string_view bytes) const;
    void read(std::span<char> to, std::optional<Clock::time_point> until) const;

    int socket_;
};

/// A failure on its way to the other process, and thrown again there as the type it had: Error, StorageError,
/// ProblemError and std::bad_alloc (also for a thread that found no room for its stack); others as
/// std::runtime_error with the same words.
Message failure(const std::exception_ptr& caught);
[[noreturn]] void throw_failure(const Message& message);

}  // namespace afterglow
