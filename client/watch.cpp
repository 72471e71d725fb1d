#include "client/watch.h"

#include "client/event_stream.h"
#include "client/problem.h"

namespace afterglow::client {

namespace {

/// How one connection ended.
enum class Attempt {
    job_ended,
    lost_after_events,
    lost_without_events,
    too_old,  ///< the server no longer keeps the events after our last one
};

class Watcher {
  public:
    Watcher(std::string place, WatchView& view, WatchReporter& reporter, const WatchLinks& links)
        : place_(std::move(place)), view_(view), reporter_(reporter), links_(links) {}

    /// One connection from its opening to its end. Errors: as watch_job; no_server where there is no reply.
    Attempt attempt() {
        HttpHeaders headers{{"Accept", "text/event-stream"}};
        if (!last_id_.empty()) headers.emplace_back("Last-Event-ID", last_id_);
        EventStreamParser parser;
        int events = 0;
        const auto sink = [&](std::string_view bytes) {
            for (const ServerEvent& event : parser.feed(bytes)) {
                ++events;
                if (take(event) == StreamNext::stop) return StreamNext::stop;
            }
            return StreamNext::more;
        };
        const HttpReply reply = links_.open(headers, sink);
        if (reply.status == 410) {
            last_id_.clear();
            return Attempt::too_old;
        }
        if (reply.status != 200) throw error_of(reply, place_, NotFound::not_found);
        if (has_ended(view_.state)) return Attempt::job_ended;
        return events > 0 ? Attempt::lost_after_events : Attempt::lost_without_events;
    }

  private:
    StreamNext take(const ServerEvent& event) {
        // Before anything can fail: an event that cannot be dealt with must not come again and again.
        if (!event.id.empty()) last_id_ = event.id;
        const WatchNews news = apply_event(view_, event, place_);
        reporter_.on_event(event, view_, news);
        if (news.kind == WatchNews::Kind::final_image && links_.on_finished) links_.on_finished(*news.image);
        return event.name == "end" ? StreamNext::stop : StreamNext::more;
    }

    std::string place_;
    WatchView& view_;
    WatchReporter& reporter_;
    const WatchLinks& links_;
    std::string last_id_;  ///< of the last event dealt with
};

ExitCode result_of(const std::string& place, const WatchView& view) {
    const ExitCode code = exit_code_of(view.state);
    if (code != ExitCode::job_failed) return code;
    if (view.error.empty()) throw ClientError(code, place, "failed");
    throw ClientError(code, "", view.error);
}

}  // namespace

ExitCode watch_job(const std::string& place, WatchView& view, WatchReporter& reporter,
                   const WatchLinks& links, Backoff backoff) {
    Watcher watcher(place, view, reporter, links);
    enum class Contact { none, made } contact = Contact::none;
    for (;;) {
        try {
            const Attempt attempt = watcher.attempt();
            if (attempt == Attempt::job_ended) return result_of(place, view);
            if (attempt == Attempt::lost_after_events) backoff.succeeded();
            contact = Contact::made;
        } catch (const ClientError& error) {
            // Before the first contact a missing server is a mistake to report, not a fault to sit out.
            if (error.code() != ExitCode::no_server || contact == Contact::none) throw;
        }
        const auto wait = backoff.next();
        if (!wait)
            throw ClientError(ExitCode::no_server, place,
                              "the connection was lost " + std::to_string(backoff.failures() + 1) +
                                  " times in a row; the job may go on");
        reporter.on_retry(*wait);
        links.sleep(*wait);
    }
}

}  // namespace afterglow::client
