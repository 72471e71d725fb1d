#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace afterglow::client {

/// `text` with every control character replaced by a blank, so that what a server sends stays on one line and
/// cannot steer the terminal. UTF-8 passes, except the two-byte C1 controls.
std::string one_line(std::string_view text);

/// Percent-encodes all but the unreserved characters of RFC 3986, for one component of a URL.
std::string percent_encode(std::string_view text);

/// A duration as people say it: "8 s", "2 min 05 s", "3 h 20 min". Negative durations count as zero.
std::string spoken(std::chrono::duration<double> duration);

/// A number of bytes with two or three significant digits: "812 bytes", "8.6 kB", "41 MB", "1.2 GB".
std::string spoken_bytes(double bytes);

/// A share as a percentage with two significant digits: 0.0123 → "1.2 %".
std::string percent(double share);

}  // namespace afterglow::client
