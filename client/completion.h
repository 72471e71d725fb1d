#pragma once

#include <string>
#include <vector>

#include "client/options.h"

namespace afterglow::client {

/// A script for bash that completes these commands, their options, and file names where no dash begins the
/// word. Thread-safety: pure.
std::string bash_completion(const std::vector<CommandSyntax>& syntax);

}  // namespace afterglow::client
