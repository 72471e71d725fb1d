#pragma once

#include <chrono>
#include <functional>
#include <iosfwd>
#include <memory>

#include "client/event_stream.h"
#include "client/options.h"
#include "client/watch_view.h"

namespace afterglow::client {

/// Shows a watcher what happens. One thread at a time. Errors of every member: local_failure where the output
/// cannot be written.
class WatchReporter {
  public:
    WatchReporter() = default;
    WatchReporter(const WatchReporter&) = delete;
    WatchReporter& operator=(const WatchReporter&) = delete;
    virtual ~WatchReporter() = default;

    /// After `event` was taken into `view` and brought `news`.
    virtual void on_event(const ServerEvent& event, const WatchView& view, const WatchNews& news) = 0;
    /// The connection was lost; the next attempt is after `wait`.
    virtual void on_retry(std::chrono::milliseconds wait) = 0;
};

/// Where a reporter writes. Both streams must outlive it.
struct ReporterOutput {
    std::ostream& out;
    std::ostream& err;
    /// Columns of the terminal that `out` is; empty where it is none.
    std::function<int()> columns;
};

/// NDJSON for OutputFormat::json: every event as {"event","id","data"}, data as the server sent it. For text:
/// one line that is redrawn where `out` is a terminal, else a line for each finished frame and change of
/// state. Warnings and lost connections go to `err`.
std::unique_ptr<WatchReporter> make_reporter(OutputFormat format, ReporterOutput output);

/// Throws local_failure where a write to standard output failed.
void check_output(std::ostream& out);

}  // namespace afterglow::client
