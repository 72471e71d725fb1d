#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace afterglow {

/// Resolves a relative URI of a scene file to bytes, or throws Error naming it. An empty function means that
/// no other files may be read.
using ResourceReader = std::function<std::string(const std::string& uri)>;

/// More than this is not read from one external file.
inline constexpr std::size_t max_resource_bytes = std::size_t{1} << 30U;

/// Reads files inside `folder` and nowhere else; what a scene file on disk may refer to.
/// The returned function percent-decodes the URI and refuses absolute paths, URIs with a scheme, backslashes,
/// zero bytes, paths that climb out with "..", and symbolic links that lead outside the folder.
/// Errors (thrown by the returned function, naming the URI): invalid_input for a refused URI; not_found; io;
/// too_large past `max_bytes`. Thread-safety: the function may be called from any thread.
ResourceReader resources_in(std::filesystem::path folder, std::size_t max_bytes = max_resource_bytes);

}  // namespace afterglow
