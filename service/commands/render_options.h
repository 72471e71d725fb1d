#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <variant>

#include "service/base/frame_range.h"
#include "service/commands/command_line.h"
#include "solver/scene/load.h"
#include "solver/sequence/config.h"

namespace afterglow {

/// What `afterglowd render` was asked to do.
struct RenderOptions {
    std::filesystem::path scene;                  ///< .glb, .gltf, .obj or .json
    std::optional<std::filesystem::path> paths;   ///< a paths document to apply
    std::optional<FrameRange> frames;             ///< the whole animation where not given
    LoadConfig load;                              ///< how the scene is read
    SequenceConfig sequence;                      ///< how it is solved and shown
    std::filesystem::path out = "out";            ///< folder of the frames
    std::optional<std::filesystem::path> report;  ///< where the report goes
    int threads = 0;                              ///< 0: one a core
    enum class Progress { shown, hidden } progress = Progress::shown;
};

/// Reads the arguments after `afterglowd render`. Errors: invalid_input naming the option, not_found for an
/// unknown name of a method, visibility, solution or quality.
std::variant<RenderOptions, HelpText> read_render_options(std::span<const char* const> arguments);

/// Where static rows are kept without --cache: $XDG_CACHE_HOME/afterglow, else ~/.cache/afterglow, else (no
/// home) nowhere. Reads the environment.
std::filesystem::path default_cache_folder();

}  // namespace afterglow
