#pragma once

#include <string>

namespace afterglow::client {

/// What the program's exit status says. The numbers are part of the command line's contract: never renumber.
enum class ExitCode : int {
    ok = 0,             ///< done; for `watch`, the job succeeded
    job_failed = 1,     ///< the watched job failed
    bad_input = 2,      ///< bad usage, or the server refused the scene, the paths or a setting
    job_cancelled = 3,  ///< the watched job was cancelled
    not_found = 4,      ///< the server knows no such job
    no_server = 5,      ///< the server cannot be reached, was lost for good, or does not answer as it should
    local_failure =
        6,  ///< a local file or standard output cannot be written, or the system refuses something
    interrupted = 130,  ///< stopped by Ctrl-C; a submitted job goes on
};

/// The table of exit codes as shown by --help, one line each.
std::string exit_code_help();

}  // namespace afterglow::client
