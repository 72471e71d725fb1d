#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace afterglow {

/// Reads a whole file. Errors: not_found; io; too_large past `max_bytes`. The message names the path as
/// given.
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{1} << 31U);

/// Writes a file so that readers see the old content or the new, never a part: to a temporary name in the
/// same folder, then renamed. Errors: io. Nothing is left behind on failure.
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace afterglow
