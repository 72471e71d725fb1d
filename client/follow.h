#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "client/commands.h"
#include "client/watch_view.h"

namespace afterglow::client {

/// Follows a job to its end and shows it as the options ask; with a folder `out`, fetches its frames as they
/// finish. `view` may already hold warnings that were told. Ctrl-C leaves the job running, says how to come
/// back and returns interrupted. Errors: as watch_job; local_failure.
ExitCode follow_job(const Session& session, const std::string& id, WatchView& view,
                    const std::optional<std::filesystem::path>& out);

}  // namespace afterglow::client
