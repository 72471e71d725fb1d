#include "service/commands/serve_options.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "service/base/option_values.h"
#include "solver/base/error.h"

namespace afterglow {

namespace {

using Text = std::optional<std::string>;

/// The options as they were typed; absent where not given.
struct Typed {
    Text listen, data, threads, resident_jobs, job_memory, connections, token_file, keep_frames_for,
        keep_at_most, keep_uploads_for;
    std::vector<std::string> hosts;
    bool access_log = false;
};

void declare_options(CLI::App& app, Typed& typed) {
    app.add_option("--listen", typed.listen,
                   "ADDRESS:PORT to listen on; port 0 takes a free one [127.0.0.1:8080]");
    app.add_option("--data", typed.data, "Folder for uploads, pictures and cache [a temporary one]");
    app.add_option("--threads", typed.threads, "Threads to solve with [one a core]");
    app.add_option("--resident-jobs", typed.resident_jobs, "Jobs whose state is in memory at a time [4]");
    app.add_option("--job-memory", typed.job_memory,
                   "Bytes of address space that each job's process may take, as 2GB [any]");
    app.add_option("--connections", typed.connections, "Connections answered at a time [256]");
    app.add_option("--keep-frames-for", typed.keep_frames_for,
                   "How long after a job's end its pictures and events are kept, as 90m, 12h or 7d [always]");
    app.add_option("--keep-at-most", typed.keep_at_most,
                   "Bytes of pictures and cache, as 500MB or 20GB; the oldest go first [any]");
    app.add_option("--keep-uploads-for", typed.keep_uploads_for,
                   "How long scenes and paths that no job has are kept after they were last used, 10m or "
                   "more [always]");
    app.add_option(
        "--token-file", typed.token_file,
        "Who may use it, a line each: NAME viewer|submitter|admin TOKEN [LIMIT=N ...] [everybody]");
    app.add_option("--host", typed.hosts, "A name it is reached by, besides localhost; may be repeated")
        ->allow_extra_args(false);
    app.add_flag("--access-log", typed.access_log, "Tell each request on standard error");
}

/// "127.0.0.1:8080", "host:8080" or "[::1]:8080".
void set_listen(ServeConfig& config, const std::string& text) {
    const auto colon = text.rfind(':');
    std::string address = text.substr(0, colon);
    const bool bracketed = address.starts_with('[') && address.ends_with(']');
    if (bracketed) address = address.substr(1, address.size() - 2);
    // Without its brackets the end of an IPv6 address cannot be told from a port.
    const bool ambiguous = !bracketed && address.find(':') != std::string::npos;
    if (colon == std::string::npos || address.empty() || ambiguous)
        throw Error(ErrorKind::invalid_input, "--listen",
                    "expected ADDRESS:PORT such as 127.0.0.1:8080 or [::1]:8080, found \"" + text + "\"");
    config.address = address;
    config.port = static_cast<int>(whole_number("--listen", text.substr(colon + 1), 0, 65535));
}

void set_keep_uploads_for(ServeConfig& config, const std::string& text) {
    // Reading a scene for a job takes up to a minute of processor time, before the job is there.
    constexpr std::chrono::minutes least{10};
    config.retention.keep_uploads_for = length_of_time("--keep-uploads-for", text);
    if (*config.retention.keep_uploads_for < least)
        throw Error(ErrorKind::invalid_input, "--keep-uploads-for",
                    "must be 10m or more, found \"" + text + "\"");
}

}  // namespace

std::variant<ServeConfig, HelpText> read_serve_options(std::span<const char* const> arguments) {
    CLI::App app("Offers rendering over HTTP until it is interrupted.", "afterglowd serve");
    Typed typed;
    declare_options(app, typed);
    if (const auto help = parse_arguments(app, arguments)) return *help;

    ServeConfig config;
    if (typed.listen) set_listen(config, *typed.listen);
    if (typed.data) {
        if (typed.data->empty()) throw Error(ErrorKind::invalid_input, "--data", "the path is empty");
        config.data_folder = *typed.data;
    }
    if (typed.threads) config.threads = static_cast<int>(whole_number("--threads", *typed.threads, 1, 1024));
    if (typed.resident_jobs)
        config.max_resident =
            static_cast<std::size_t>(whole_number("--resident-jobs", *typed.resident_jobs, 1, 1024));
    if (typed.job_memory) config.job_memory = byte_count("--job-memory", *typed.job_memory);
    if (typed.connections)
        config.max_connections =
            static_cast<std::size_t>(whole_number("--connections", *typed.connections, 1, 10000));
    if (typed.keep_frames_for)
        config.retention.keep_for = length_of_time("--keep-frames-for", *typed.keep_frames_for);
    if (typed.keep_at_most) config.retention.keep_at_most = byte_count("--keep-at-most", *typed.keep_at_most);
    if (typed.keep_uploads_for) set_keep_uploads_for(config, *typed.keep_uploads_for);
    if (typed.token_file) {
        if (typed.token_file->empty())
            throw Error(ErrorKind::invalid_input, "--token-file", "the path is empty");
        config.token_file = *typed.token_file;
    }
    config.hosts = typed.hosts;
    if (typed.access_log) config.access_log = AccessLog::on;
    return config;
}

}  // namespace afterglow
