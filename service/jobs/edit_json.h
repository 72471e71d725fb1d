#pragma once

#include <cstddef>
#include <vector>

#include "service/jobs/edit.h"
#include "solver/base/json.h"

namespace afterglow {

inline constexpr std::size_t max_edits_of_a_request = 100;

/// Reads one edit as http-api.md describes it. Errors: invalid_input at the field, also for fields that do
/// not exist. Thread-safety: pure.
Edit read_edit(const JsonView& edit);

/// Reads `{"edits": [edit, …]}`: at least one, at most `max_edits_of_a_request`. Errors: likewise, too_large.
std::vector<Edit> read_edits(const JsonView& request);

/// `{"revision","first_frame","reused","edits"}`.
Json to_json(const JobEdit& edit, int revision);

/// A list of edits as it is kept, and read back.
Json sources_of(const std::vector<Edit>& edits);
std::vector<Edit> edits_of_sources(const Json& sources);

/// What can be edited in a world, and how it now is: objects with their bounds at time 0, materials, lamps
/// without surface, cameras. `uploaded`: before any edits, for how much of its light a lamp now gives.
Json editable_json(const World& world, const World& uploaded);

}  // namespace afterglow
