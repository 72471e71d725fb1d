#pragma once

#include <map>
#include <string>
#include <string_view>

#include "solver/scene/resources.h"

namespace afterglow {

/// A scene with the files it refers to. Names are paths with slashes, relative to one folder that all are in.
/// Views: the bytes must outlive it.
struct Bundle {
    std::string main;                               ///< the scene's name, one of the files
    std::map<std::string, std::string_view> files;  ///< name → content
};

/// Whether a name is a plain path inside its folder: UTF-8 without control characters, backslashes, colons,
/// a slash in front or behind, and parts that are empty, "." or ".."; 1 to 500 bytes. Thread-safety: pure.
bool is_plain_path(std::string_view name);

/// All of it as one sequence of bytes; the same for the same files in whatever order they came. A line
/// "afterglow bundle 1", a line of JSON {"main", "files": [[name, bytes], …]}, then the contents one after
/// the other. Every name must be plain and `main` among them. Thread-safety: pure.
std::string pack(const Bundle& bundle);

/// The same read back; `name` stands for the bytes in errors. Errors: invalid_input where they are no bundle.
/// Thread-safety: pure; any bytes are allowed.
Bundle unpack(std::string_view bytes, const std::string& name);

/// Reads the files that the scene refers to, relative to the scene's own folder, as `resources_in` does. The
/// bytes of the bundle must outlive the returned function. Errors (thrown by it): invalid_input for a refused
/// URI; not_found. Thread-safety: the function may be called from any thread.
ResourceReader resources_of(const Bundle& bundle);

}  // namespace afterglow
