#pragma once

// The only place of the client that includes nlohmann-json.

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "client/error.h"

namespace afterglow::client {

using Json = nlohmann::ordered_json;

/// Parses JSON that a server sent. `place` names it in errors. Errors: no_server for malformed text, and for
/// text that nests deeper than 64 levels (writing it out again is recursive).
Json parse_json(std::string_view text, const std::string& place);

// Forgiving reads: a member that is missing, null or of another type is simply absent, so that a newer server
// still works.
std::optional<std::string> find_string(const Json& object, std::string_view key);
std::optional<double> find_number(const Json& object, std::string_view key);
std::optional<int> find_int(const Json& object, std::string_view key);
/// The member, or null (a JSON value) where there is none.
const Json& find_member(const Json& object, std::string_view key);
/// True only where the member is the JSON value true.
bool is_true(const Json& object, std::string_view key);
/// The member, which must be a string. Errors: no_server naming `place` and the key.
std::string need_string(const Json& object, std::string_view key, const std::string& place);

/// One line of JSON text; bytes that are not UTF-8 are replaced rather than refused.
std::string to_line(const Json& value);

}  // namespace afterglow::client
