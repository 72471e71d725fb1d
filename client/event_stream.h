#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace afterglow::client {

/// One server-sent event.
struct ServerEvent {
    std::string name;  ///< "message" where the stream gave none
    std::string id;    ///< the last id seen when the event was complete; may be empty
    std::string data;  ///< lines joined by \n
};

/// Incremental parser of `text/event-stream`: bytes in, in pieces of any size; complete events out.
/// Source: WHATWG HTML, 9.2.6 "Interpreting an event stream". The `retry` field is ignored: the client has
/// its own schedule. One parser serves one connection: an event cut off by its end is never
/// returned. Thread-safety: one thread at a time.
class EventStreamParser {
  public:
    /// An event may hold this many bytes; more is an error, since nothing we read comes near it.
    static constexpr std::size_t max_event_bytes = std::size_t{16} << 20U;

    /// Takes more bytes and returns the events they complete. Errors: no_server past max_event_bytes.
    std::vector<ServerEvent> feed(std::string_view bytes);

  private:
    void end_line(std::vector<ServerEvent>& events);
    void take_field(std::string_view field, std::string_view value);

    enum class Previous { other, carriage_return };
    Previous previous_ = Previous::other;
    enum class Position { first_line, later };
    Position position_ = Position::first_line;
    std::string line_;
    std::string name_;
    std::string data_;
    std::string id_;  ///< the last one seen; it holds for later events too
};

}  // namespace afterglow::client
