#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "client/backoff.h"
#include "client/http.h"
#include "client/watch_reporter.h"
#include "client/watch_view.h"

namespace afterglow::client {

/// What watching needs from outside; tests put scripts in their place.
struct WatchLinks {
    /// Opens the job's event stream with these headers, as HttpConnection::stream does.
    std::function<HttpReply(const HttpHeaders&, const StreamSink&)> open;
    /// Waits before a new attempt.
    std::function<void(std::chrono::milliseconds)> sleep;
    /// Called for every frame that becomes final; may be empty.
    std::function<void(const FrameImage&)> on_finished;
};

/// Follows a job's events until it ends, through lost connections: each new attempt resumes after the last
/// event seen, or starts over with a snapshot where the server keeps that no longer (410). `place` names the
/// job in errors; `view` may already hold warnings that were told.
/// Returns how the job ended: ok or job_cancelled. Errors: job_failed with the job's own error line;
/// not_found; no_server where the first attempt finds none, or where all attempts of `backoff` in a row
/// brought no event; interrupted.
ExitCode watch_job(const std::string& place, WatchView& view, WatchReporter& reporter,
                   const WatchLinks& links, Backoff backoff = Backoff());

}  // namespace afterglow::client
