#pragma once

#include <span>

#include "service/http/embedded_file.h"

namespace afterglow {

/// The page that browsers are given, as it stood in service/viewer when the program was built. Thread-safety:
/// pure.
std::span<const EmbeddedFile> viewer_files();

}  // namespace afterglow
