#pragma once

#include <string_view>

#include "service/http/http_message.h"

namespace afterglow {

/// A file whose bytes are a part of the program; made by embed.cmake.
struct EmbeddedFile {
    std::string_view name;  ///< without a folder
    std::string_view content_type;
    std::string_view bytes;
};

/// The file, or 304 where the reader has it. Thread-safety: pure.
Reply file_reply(const Request& request, const EmbeddedFile& file);

}  // namespace afterglow
