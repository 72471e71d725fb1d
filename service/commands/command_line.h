#pragma once

#include <optional>
#include <span>
#include <string>

namespace CLI {
class App;
}

namespace afterglow {

/// What is shown instead of working when help is asked for.
struct HelpText {
    std::string text;
};

/// Splits the arguments of one command into the options that `app` declares. Returns the help text where it
/// is asked for. Errors: invalid_input in one line for unknown, missing or repeated options.
std::optional<HelpText> parse_arguments(CLI::App& app, std::span<const char* const> arguments);

}  // namespace afterglow
