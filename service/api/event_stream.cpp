#include "service/api/event_stream.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

namespace afterglow {

std::string sse_text(std::uint64_t id, std::string_view name, std::string_view data) {
    std::string text = "id: " + std::to_string(id) + "\nevent: ";
    text += name;
    text += "\ndata: ";
    text += data;  // JSON without line breaks
    text += "\n\n";
    return text;
}

std::string ndjson_text(std::uint64_t id, std::string_view name, std::string_view data) {
    std::string text = "{\"event\":\"" + std::string(name) + "\",\"id\":" + std::to_string(id) + ",\"data\":";
    text += data;  // JSON without line breaks
    text += "}\n";
    return text;
}

const EventFormat sse_format{"text/event-stream", sse_text, ": events\n\n", ": still here\n\n"};
const EventFormat ndjson_format{"application/x-ndjson", ndjson_text, "\n", "\n"};

const EventFormat& format_accepted(std::string_view accept) {
    std::string types(accept);
    std::transform(types.begin(), types.end(), types.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool wants_lines = types.find(ndjson_format.content_type) != std::string::npos;
    return wants_lines && types.find(sse_format.content_type) == std::string::npos ? ndjson_format
                                                                                   : sse_format;
}

std::vector<Event> without_superseded(std::vector<Event> events) {
    std::set<int> seen;
    std::vector<Event> kept;
    for (auto event = events.rbegin(); event != events.rend(); ++event) {
        const bool is_image = event->kind == EventKind::image || event->kind == EventKind::final_image;
        const bool is_newest = is_image && seen.insert(event->frame).second;
        if (event->kind != EventKind::image || is_newest) kept.push_back(std::move(*event));
    }
    std::reverse(kept.begin(), kept.end());
    return kept;
}

EventStream::EventStream(std::shared_ptr<const EventLog> log, std::uint64_t after, std::string opening,
                         EventStreamConfig config)
    : log_(std::move(log)), reached_(after), opening_(std::move(opening)), config_(config) {}

Piece EventStream::next() {
    if (!opening_.empty()) return {std::exchange(opening_, {}), Piece::Then::more};
    EventLog::Batch batch = log_->wait_after(reached_, config_.wait);
    if (batch.status != EventLog::Status::open) return {"", Piece::Then::end};

    if (batch.events.empty()) {
        was_up_to_date_ = true;
        if (Clock::now() - last_sent_ < config_.heartbeat) return {};
        last_sent_ = Clock::now();
        return {config_.format->heartbeat, Piece::Then::more};
    }
    reached_ = batch.events.back().id;
    if (was_up_to_date_ && batch.fill == EventLog::Fill::full)
        batch.events = without_superseded(std::move(batch.events));
    Piece piece;
    for (const Event& event : batch.events)
        piece.bytes += config_.format->text(event.id, name_of(event.kind), event.data);
    if (batch.events.back().kind == EventKind::end) piece.then = Piece::Then::end;
    last_sent_ = Clock::now();
    return piece;
}

}  // namespace afterglow
