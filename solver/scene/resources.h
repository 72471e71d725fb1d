#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace afterglow {

/// Resolves a relative URI of a scene file to bytes, or throws Error naming it. An empty function means that
/// no other files may be read.
using ResourceReader = std::function<std::string(const std::string& uri)>;

/// More than this is not read from one external file.
inline constexpr std::size_t max_resource_bytes = std::size_t{1} << 30U;

/// Reads files inside `folder` and nowhere else; what a scene file on disk may refer to.
/// The returned function percent-decodes the URI, takes backslashes for slashes (as Windows programs write
/// them), and refuses absolute paths, URIs with a scheme, zero bytes, paths that climb out with "..", and
/// symbolic links that lead outside the folder.
/// Errors (thrown by the returned function, naming the URI): invalid_input for a refused URI; not_found; io;
/// too_large past `max_bytes`. Thread-safety: the function may be called from any thread.
ResourceReader resources_in(std::filesystem::path folder, std::size_t max_bytes = max_resource_bytes);

/// The path that a URI stands for, relative to the folder of the file that names it, with slashes: what
/// `resources_in` says of a URI without looking at any file. Errors: invalid_input for a refused URI.
/// Thread-safety: pure.
std::filesystem::path relative_path(const std::string& uri);

/// Text from a file made fit for a one-line message: in double quotes, control characters replaced, at most
/// about 80 bytes. Valid UTF-8 stays valid.
std::string in_quotes(std::string_view text);

}  // namespace afterglow
