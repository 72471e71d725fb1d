#include "service/commands/command_line.h"

#include <algorithm>
#include <vector>

#include <CLI/CLI.hpp>

#include "solver/base/error.h"

namespace afterglow {

std::optional<HelpText> parse_arguments(CLI::App& app, std::span<const char* const> arguments) {
    std::vector<std::string> reversed(arguments.begin(), arguments.end());
    std::reverse(reversed.begin(), reversed.end());  // the parser takes them from the back
    try {
        app.parse(std::move(reversed));
    } catch (const CLI::CallForHelp&) {
        return HelpText{app.help()};
    } catch (const CLI::ParseError& e) {
        throw Error(ErrorKind::invalid_input, "", e.what());
    }
    return std::nullopt;
}

}  // namespace afterglow
