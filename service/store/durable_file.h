#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace afterglow {

/// Writes a file so that readers see all of it or nothing: to a temporary name in its folder, then renamed.
/// It outlasts the process, but the machine only once `make_durable` has returned. Errors: StorageError;
/// nothing is left behind.
void put_file(const std::filesystem::path& path, std::string_view content);

/// Makes written files and their names outlast a crash of the machine (fsync of each file, then of each
/// folder once). Errors: StorageError. Files that are gone are left out.
void make_durable(const std::vector<std::filesystem::path>& files);

}  // namespace afterglow
