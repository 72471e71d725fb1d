#pragma once

#include <span>
#include <string_view>

namespace afterglow {

/// A file of the page that browsers are given; the bytes are a part of the program.
struct ViewerFile {
    std::string_view name;  ///< without a folder
    std::string_view content_type;
    std::string_view bytes;
};

/// All of them, as they stood in service/viewer when the program was built. Thread-safety: pure.
std::span<const ViewerFile> viewer_files();

}  // namespace afterglow
