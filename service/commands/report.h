#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "solver/base/json.h"
#include "solver/sequence/sequence.h"

namespace afterglow {

/// What a run cost. load + static pass + the frames' totals are the run's wall time.
struct Report {
    std::string scene;            ///< as given
    Milliseconds load{};          ///< from the start of the program to the scene in memory
    Milliseconds static_pass{};   ///< meshing, acceleration structures and the pass over the furniture
    SequenceStatistics sequence;  ///< counts, and the method
    std::vector<FrameStatistics> frames;  ///< `total` with waiting for the files
};

/// The most memory this process has held so far, in millions of bytes. Errors: none. Thread-safe.
double peak_memory_mb();

/// The report as JSON, times in milliseconds: see service/report.md for every field. Thread-safety: pure.
Json to_json(const Report& report, double peak_rss_mb);

/// Fails where a file cannot be written at `path`, without touching what stands there, so that this is known
/// before hours of work. Errors: invalid_input.
void require_writable_file(const std::filesystem::path& path);

}  // namespace afterglow
