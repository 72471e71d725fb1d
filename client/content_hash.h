#pragma once

#include <string>
#include <string_view>

namespace afterglow::client {

/// SHA-256 in lower-case hexadecimal (FIPS 180-4): the name of a blob on the server. The only user of OpenSSL
/// besides cpp-httplib. Thread-safety: pure.
std::string sha256(std::string_view content);

}  // namespace afterglow::client
