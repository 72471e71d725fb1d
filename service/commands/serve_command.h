#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "service/base/limits.h"
#include "service/http/http_server.h"
#include "service/store/retention.h"

namespace afterglow {

/// How `afterglowd serve` works.
struct ServeConfig {
    std::string address = "127.0.0.1";  ///< to listen on; a numeric IPv4 or IPv6 address or a host name
    int port = 8080;                    ///< 0: any free one
    std::filesystem::path
        data_folder;               ///< uploads, pictures, cache; empty: a temporary one, removed at the end
    int threads = 0;               ///< for the solver; 0: one a core
    std::size_t max_resident = 4;  ///< jobs that are computed in turn, each with its state in memory
    std::uint64_t job_memory = 0;  ///< bytes that each job's process may take beyond its start; 0: any
    std::size_t max_connections = 256;      ///< answered at a time; more are told 503
    Limits limits;                          ///< what a client may ask for
    RetentionConfig retention;              ///< how long and how much is kept
    std::filesystem::path token_file;       ///< who may use it; empty: everybody, on loopback only
    std::vector<std::string> hosts;         ///< names it is reached by, besides localhost
    AccessLog access_log = AccessLog::off;  ///< whether each request is told on standard error
};

/// Runs the service until `stop` is requested; jobs that have not ended by then are cancelled. Prints
/// `listening on http://ADDRESS:PORT` to standard output once requests are answered. Returns the exit status,
/// 0. Errors: io where the address is taken, or the data folder is in use or cannot be written; invalid_input
/// for an address that others can reach when there are no tokens, and for a token file that makes no sense.
int serve(const ServeConfig& config, const std::stop_token& stop);

}  // namespace afterglow
