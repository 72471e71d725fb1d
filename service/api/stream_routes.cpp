#include <limits>

#include "service/api/event_stream.h"
#include "service/api/live_stream.h"
#include "service/api/routes.h"
#include "service/base/option_values.h"

namespace afterglow {

namespace {

/// The id the client has reached; nothing where it names none.
std::optional<std::uint64_t> last_event_id(const Request& request) {
    std::string text = request.header("last-event-id");
    if (text.empty()) text = request.parameter("last_event_id");
    if (text.empty()) return std::nullopt;
    return static_cast<std::uint64_t>(
        whole_number("Last-Event-ID", text, 0, std::numeric_limits<std::int64_t>::max()));
}

/// The id from which a reader without one goes on after its snapshot: what is new from here, or the end again
/// where all is over, since every stream of an ended job ends with `end`.
std::uint64_t present(const EventLog& log) {
    const auto end = log.end();
    return end ? end->id - 1 : log.last_id();
}

std::string snapshot_text(const RouteContext& context, const std::string& id, std::uint64_t after,
                          const EventFormat& format) {
    const Job job = job_at(context.jobs, id);
    Json snapshot = to_json(job);
    snapshot["frames"] = Json::array();
    for (const FrameInfo& info : context.frames.newest(id))
        snapshot["frames"].push_back(frame_json(job, info));
    return format.text(after, "snapshot", dump(snapshot));
}

Reply get_events(const RouteContext& context, const Request& request, const std::string& id) {
    job_at(context.jobs, id);
    const auto log = events_at(context.jobs, id);
    const auto reached = last_event_id(request);
    std::uint64_t after = 0;
    const EventFormat& format = format_accepted(request.header("accept"));
    std::string opening = format.opening;
    if (reached) {
        after = *reached;
        const auto batch = log->wait_after(after, std::chrono::milliseconds(0));
        if (batch.status == EventLog::Status::too_old || after > log->last_id())
            throw ProblemError({410, "gone", "events from there are kept no longer", "Last-Event-ID"});
    } else {
        // The id first: an event between the two is then told twice, never lost.
        after = present(*log);
        opening = snapshot_text(context, id, after, format);
    }
    Reply reply;
    reply.content_type = format.content_type;
    reply.headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}, {"Vary", "Accept"}};
    EventStreamConfig config;
    config.format = &format;
    reply.stream = context.usage.counted(
        request.client, std::make_shared<EventStream>(log, after, std::move(opening), config));
    return reply;
}

Reply get_live(const RouteContext& context, const Request& request, const std::string& id) {
    job_at(context.jobs, id);
    Reply reply;
    reply.content_type = live_content_type;
    reply.headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}};
    reply.stream = context.usage.counted(
        request.client, std::make_shared<LiveStream>(id, events_at(context.jobs, id), context.frames));
    return reply;
}

}  // namespace

void add_stream_routes(Router& router, const RouteContext& context) {
    router.add("GET", "/v1/jobs/{}/events", [context](const Request& request, const PathValues& values) {
        return get_events(context, request, values[0]);
    });
    router.add("GET", "/v1/jobs/{}/live", [context](const Request& request, const PathValues& values) {
        return get_live(context, request, values[0]);
    });
}

}  // namespace afterglow
