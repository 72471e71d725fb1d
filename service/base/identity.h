#pragma once

#include <string>
#include <string_view>

namespace afterglow {

/// A new name for a job: 12 characters, safe in URLs, file names and on command lines, 60 random bits.
std::string random_id();

/// A name made from content: the first 128 bits of its SHA-256 in hexadecimal. Equal content has equal names,
/// and nobody can make other content with the same name. Source: FIPS 180-4.
std::string content_id(std::string_view content);

/// SHA-256 in lower-case hexadecimal, 64 characters. Source: FIPS 180-4.
std::string sha256(std::string_view content);

}  // namespace afterglow
