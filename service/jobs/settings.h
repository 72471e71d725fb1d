#pragma once

#include <string>

#include "service/base/limits.h"
#include "service/jobs/job.h"
#include "solver/base/json.h"

namespace afterglow {

/// What `POST /v1/jobs` asks for.
struct JobRequest {
    std::string scene;  ///< id of an upload
    std::string paths;  ///< id of an upload; empty: none
    JobSettings settings;
};

/// Reads a job request; settings left out keep the defaults of SequenceConfig. Errors: invalid_input,
/// not_found or too_large at the field, also for fields that do not exist. Thread-safety: pure.
JobRequest read_job_request(const JsonView& request, const Limits& limits);

/// Reads a change of a job, a merge patch (RFC 7396) whose only member is `priority`, −10 to 10 or null for
/// 0; nothing where it has none. Errors: invalid_input naming the field.
std::optional<int> read_priority(const JsonView& patch);

/// Reads the settings alone.
JobSettings read_settings(const JsonView& settings, const Limits& limits);

}  // namespace afterglow
