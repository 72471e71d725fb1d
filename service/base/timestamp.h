#pragma once

#include <chrono>
#include <string>

namespace afterglow {

/// A moment as the service records it.
using Timestamp = std::chrono::system_clock::time_point;

/// RFC 3339 in UTC with milliseconds: "2024-02-29T12:00:00.000Z".
std::string to_rfc3339(Timestamp time);

}  // namespace afterglow
