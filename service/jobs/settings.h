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

/// Reads the settings alone.
JobSettings read_settings(const JsonView& settings, const Limits& limits);

}  // namespace afterglow
