#pragma once

#include <functional>
#include <iosfwd>

#include "client/http.h"
#include "client/interrupt.h"
#include "client/options.h"

namespace afterglow::client {

/// What every command works with. All must outlive it.
struct Session {
    const Options& options;
    Interrupt& interrupt;
    std::ostream& out;
    std::ostream& err;
    std::function<int()> columns;  ///< of the terminal that `out` is; empty where it is none
};

/// A connection to the session's server.
HttpConnection connect(const Session& session);
/// Where a job stands on any server.
std::string job_path(const std::string& id);

/// Runs the chosen command. Returns ok, or for a watched job how it ended. Errors: ClientError.
ExitCode run_command(const Session& session);

/// Uploads a scene and its paths, makes a job, and follows it where that was asked. Warnings go to `err`.
ExitCode run_submit(const Session& session, const SubmitCommand& command);
/// Follows a job to its end. Ctrl-C leaves the job running and says how to come back.
ExitCode run_watch(const Session& session, const WatchCommand& command);
/// Fetches the frames that are finished now.
ExitCode run_get(const Session& session, const GetCommand& command);
ExitCode run_list(const Session& session);
ExitCode run_show(const Session& session, const ShowCommand& command);
ExitCode run_step(const Session& session, const StepCommand& command);
ExitCode run_priority(const Session& session, const PriorityCommand& command);
/// Edits a job as it is now. Errors: also bad_input where it was edited meanwhile, unless that is to be
/// retried.
ExitCode run_edit(const Session& session, const EditCommand& command);
ExitCode run_editable(const Session& session, const EditableCommand& command);
ExitCode run_remove(const Session& session, const RemoveCommand& command);
/// One line for each thing that is checked. Returns no_server where the server is of no use.
ExitCode run_doctor(const Session& session);
ExitCode run_completion(const Session& session);

}  // namespace afterglow::client
