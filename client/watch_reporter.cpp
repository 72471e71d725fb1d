#include "client/watch_reporter.h"

#include <charconv>
#include <ostream>
#include <utility>

#include "client/progress_line.h"

namespace afterglow::client {

namespace {

using Kind = WatchNews::Kind;

std::string retry_text(std::chrono::milliseconds wait) {
    return "connection lost, next attempt in " + std::to_string(wait.count()) + " ms";
}

/// Ids are numbers by the interface; anything else is kept as text.
Json id_json(const std::string& id) {
    if (id.empty()) return nullptr;
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), number);
    if (error != std::errc() || end != id.data() + id.size()) return id;
    return number;
}

class LineReporter : public WatchReporter {
  public:
    explicit LineReporter(ReporterOutput output) : output_(std::move(output)) {}

    void on_event(const ServerEvent&, const WatchView& view, const WatchNews& news) override {
        for (const std::string& warning : news.warnings) output_.err << "warning: " << warning << std::endl;
        if (news.kind == Kind::edit) output_.out << news.told << std::endl;
        if (news.kind == Kind::state) output_.out << state_line(view) << std::endl;
        if (news.kind == Kind::final_image) output_.out << finished_line(view, *news.image) << std::endl;
        check_output(output_.out);
    }
    void on_retry(std::chrono::milliseconds wait) override { output_.err << retry_text(wait) << std::endl; }

  private:
    ReporterOutput output_;
};

class JsonReporter : public WatchReporter {
  public:
    explicit JsonReporter(ReporterOutput output) : output_(std::move(output)) {}

    void on_event(const ServerEvent& event, const WatchView&, const WatchNews& news) override {
        for (const std::string& warning : news.warnings) output_.err << "warning: " << warning << std::endl;
        Json line;
        line["event"] = event.name;
        line["id"] = id_json(event.id);
        line["data"] = parse_json(event.data, "event stream");
        output_.out << to_line(line) << std::endl;
        check_output(output_.out);
    }
    void on_retry(std::chrono::milliseconds wait) override { output_.err << retry_text(wait) << std::endl; }

  private:
    ReporterOutput output_;
};

class TerminalReporter : public WatchReporter {
  public:
    explicit TerminalReporter(ReporterOutput output) : output_(std::move(output)) {}
    ~TerminalReporter() override {
        if (drawn_ == Drawn::yes) output_.out << std::endl;
    }
    TerminalReporter(const TerminalReporter&) = delete;
    TerminalReporter& operator=(const TerminalReporter&) = delete;

    void on_event(const ServerEvent&, const WatchView& view, const WatchNews& news) override {
        for (const std::string& warning : news.warnings) tell("warning: " + warning);
        if (news.kind == Kind::edit) tell(news.told);
        // A full line would wrap on some terminals, and the return would then redraw the wrong one.
        output_.out << '\r' << progress_line(view, output_.columns() - 1) << "\x1b[K" << std::flush;
        drawn_ = Drawn::yes;
        check_output(output_.out);
    }
    void on_retry(std::chrono::milliseconds wait) override { tell(retry_text(wait)); }

  private:
    void tell(const std::string& text) {
        if (drawn_ == Drawn::yes) output_.out << "\r\x1b[K" << std::flush;
        drawn_ = Drawn::no;
        output_.err << text << std::endl;
    }

    enum class Drawn { no, yes };
    Drawn drawn_ = Drawn::no;
    ReporterOutput output_;
};

}  // namespace

std::unique_ptr<WatchReporter> make_reporter(OutputFormat format, ReporterOutput output) {
    if (format == OutputFormat::json) return std::make_unique<JsonReporter>(std::move(output));
    if (output.columns) return std::make_unique<TerminalReporter>(std::move(output));
    return std::make_unique<LineReporter>(std::move(output));
}

void check_output(std::ostream& out) {
    if (!out) throw ClientError(ExitCode::local_failure, "standard output", "cannot be written");
}

}  // namespace afterglow::client
