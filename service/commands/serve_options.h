#pragma once

#include <span>
#include <variant>

#include "service/commands/command_line.h"
#include "service/commands/serve_command.h"

namespace afterglow {

/// Reads the arguments after `afterglowd serve`. Errors: invalid_input naming the option.
/// Thread-safety: pure.
std::variant<ServeConfig, HelpText> read_serve_options(std::span<const char* const> arguments);

}  // namespace afterglow
