#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "solver/base/hash.h"
#include "solver/visibility/static_pass.h"

namespace afterglow {

/// Identifies a static pass by what it depends on: the furniture's geometry, its patches and the lines'
/// settings. Actors, paths, cameras and colours do not matter, so that jobs that differ in these share one
/// pass.
Hash128 static_key(const World& world, const PatchMesh& mesh, const SightLines& lines, const Lamps& lamps,
                   Index light_lines_per_patch, std::uint64_t seed);

/// Reads a kept static pass. Nothing where there is none, or where the file is damaged, cut short, of another
/// version or of another key: then it is to be computed again. Never throws for a bad file.
std::optional<StaticLines> load_static_lines(const std::filesystem::path& folder, const Hash128& key,
                                             const PatchMesh& mesh, Index lines_per_patch,
                                             Index light_lines_per_patch);

/// Keeps a static pass for later jobs. Errors: io where the folder cannot be made or written.
void save_static_lines(const std::filesystem::path& folder, const Hash128& key, const StaticLines& lines);

}  // namespace afterglow
