#include "client/event_stream.h"

#include <utility>

#include "client/error.h"

namespace afterglow::client {

std::vector<ServerEvent> EventStreamParser::feed(std::string_view bytes) {
    std::vector<ServerEvent> events;
    for (const char c : bytes) {
        const Previous previous =
            std::exchange(previous_, c == '\r' ? Previous::carriage_return : Previous::other);
        if (c == '\n' && previous == Previous::carriage_return) continue;  // the second half of CRLF
        if (c == '\n' || c == '\r') {
            end_line(events);
            continue;
        }
        line_ += c;
        if (line_.size() + data_.size() > max_event_bytes)
            throw ClientError(ExitCode::no_server, "event stream", "an event is larger than 16 MiB");
    }
    return events;
}

void EventStreamParser::end_line(std::vector<ServerEvent>& events) {
    const std::string line = std::exchange(line_, {});
    std::string_view rest = line;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (std::exchange(position_, Position::later) == Position::first_line &&
        rest.starts_with(byte_order_mark))
        rest.remove_prefix(byte_order_mark.size());
    if (!rest.empty()) {
        const auto colon = rest.find(':');
        std::string_view value = colon == std::string_view::npos ? "" : rest.substr(colon + 1);
        if (value.starts_with(' ')) value.remove_prefix(1);
        take_field(rest.substr(0, colon), value);
        return;
    }
    std::string name = std::exchange(name_, {});
    std::string data = std::exchange(data_, {});
    if (data.empty()) return;
    data.pop_back();
    events.push_back({name.empty() ? "message" : std::move(name), id_, std::move(data)});
}

void EventStreamParser::take_field(std::string_view field, std::string_view value) {
    if (field == "event") {
        name_ = value;
    } else if (field == "data") {
        data_ += value;
        data_ += '\n';
    } else if (field == "id" && value.find('\0') == std::string_view::npos) {
        id_ = value;
    }
    // A comment has an empty field name; it and unknown fields are passed over.
}

}  // namespace afterglow::client
