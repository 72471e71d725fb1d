#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/options.h"

namespace CLI {
class App;
}

namespace afterglow::client {

/// What the command line says of an edit, before it is put together. A parser's target: it must stay where it
/// is while the command line is read.
struct EditText {
    std::string id, name, file;
    std::string by, position, look_at, emission, intensity, reflectance, camera;
    std::optional<double> turn_degrees, scale, from_s;
    bool retries = false;
};

/// Defines `edit` with its kinds on a program's command line.
CLI::App& define_edit(CLI::App& edit, EditText& text);

/// The command that was read: an EditCommand, or `edit show`. Errors: bad_input naming the option.
Command edit_command(const CLI::App& edit, const EditText& text);

/// "1,0,-0.5" → three finite numbers. Errors: bad_input naming the option.
std::vector<double> parse_vector(const std::string& option, const std::string& text);

}  // namespace afterglow::client
