#include "service/http/http_message.h"

#include <algorithm>
#include <cctype>

namespace afterglow {

namespace {
std::string value_or_empty(const std::map<std::string, std::string>& values, const std::string& name) {
    const auto it = values.find(name);
    return it == values.end() ? std::string() : it->second;
}
}  // namespace

std::string Request::header(const std::string& name) const {
    return value_or_empty(headers, name);
}

std::string Request::parameter(const std::string& name) const {
    return value_or_empty(query, name);
}

std::string Request::media_type() const {
    std::string type = header("content-type");
    type = type.substr(0, type.find(';'));
    while (!type.empty() && type.back() == ' ') type.pop_back();
    std::transform(type.begin(), type.end(), type.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return type;
}

std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Reply json_reply(const Json& json, int status) {
    return {status, "application/json", dump(json) + "\n", {}, nullptr};
}

Reply problem_reply(const Problem& problem) {
    Reply reply{problem.status, "application/problem+json", dump(to_json(problem)) + "\n", {}, nullptr};
    // Jobs and streams end after a while.
    if (problem.status == 429) reply.headers.emplace_back("Retry-After", "10");
    return reply;
}

}  // namespace afterglow
