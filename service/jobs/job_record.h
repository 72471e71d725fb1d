#pragma once

#include "service/jobs/job.h"
#include "solver/base/json.h"

namespace afterglow {

/// A job as it is kept on disk: everything that must outlast the process. What is told of work in progress
/// (`progress`, `doing`, `remaining`) is left out, and so are the pictures and the edits,
/// which have tables of their own.
Json to_record(const Job& job);

/// Statistics that `to_json` has written; those that are missing are empty.
SequenceStatistics sequence_statistics_of(const Json& json);

/// A job read back. A job that was running waits for its turn again. Errors: invalid_input for a record
/// that this version cannot read.
Job job_of_record(const Json& record);

}  // namespace afterglow
