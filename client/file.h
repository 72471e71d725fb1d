#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace afterglow::client {

/// Reads a whole file that the user named. Errors: bad_input naming it where it is missing, no regular file,
/// unreadable, or larger than 2 GiB.
std::string read_input(const std::filesystem::path& path);

/// Writes a file, and the folders above it, so that readers see the old content or the new, never a part.
/// Errors: local_failure naming it; nothing is left behind.
void write_output(const std::filesystem::path& path, std::string_view content);

/// The content type that a scene's file name stands for. Errors: bad_input naming the endings that are known.
std::string scene_content_type(const std::filesystem::path& path);

}  // namespace afterglow::client
