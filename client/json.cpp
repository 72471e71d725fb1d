#include "client/json.h"

#include <limits>

namespace afterglow::client {

namespace {

constexpr int max_depth = 64;

}  // namespace

Json parse_json(std::string_view text, const std::string& place) {
    const auto guard = [&](int depth, Json::parse_event_t, Json&) {
        if (depth > max_depth) throw ClientError(ExitCode::no_server, place, "sent JSON that nests too deep");
        return true;
    };
    try {
        return Json::parse(text, guard);
    } catch (const Json::exception&) {
        throw ClientError(ExitCode::no_server, place, "sent text that is not JSON");
    }
}

const Json& find_member(const Json& object, std::string_view key) {
    static const Json nothing;
    if (!object.is_object()) return nothing;
    const auto found = object.find(std::string(key));
    return found == object.end() ? nothing : *found;
}

std::optional<std::string> find_string(const Json& object, std::string_view key) {
    const Json& value = find_member(object, key);
    if (!value.is_string()) return std::nullopt;
    return value.get<std::string>();
}

std::optional<double> find_number(const Json& object, std::string_view key) {
    const Json& value = find_member(object, key);
    if (!value.is_number()) return std::nullopt;
    return value.get<double>();
}

std::optional<int> find_int(const Json& object, std::string_view key) {
    const Json& value = find_member(object, key);
    if (!value.is_number_integer()) return std::nullopt;
    const auto wide = value.get<std::int64_t>();
    if (wide < std::numeric_limits<int>::min() || wide > std::numeric_limits<int>::max()) return std::nullopt;
    return static_cast<int>(wide);
}

bool is_true(const Json& object, std::string_view key) {
    const Json& value = find_member(object, key);
    return value.is_boolean() && value.get<bool>();
}

std::string need_string(const Json& object, std::string_view key, const std::string& place) {
    const auto value = find_string(object, key);
    if (!value)
        throw ClientError(ExitCode::no_server, place, "sent a reply without \"" + std::string(key) + "\"");
    return *value;
}

std::string to_line(const Json& value) {
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace afterglow::client
