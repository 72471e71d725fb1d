#pragma once

#include <span>

#include "service/http/embedded_file.h"

namespace afterglow {

/// What describes the interface to programs: openapi.json. Thread-safety: pure.
std::span<const EmbeddedFile> api_files();

}  // namespace afterglow
