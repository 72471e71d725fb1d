#include "service/http/router.h"

#include <optional>
#include <utility>

namespace afterglow {

namespace {

std::vector<std::string> segments_of(std::string_view path) {
    std::vector<std::string> segments;
    while (!path.empty()) {
        path.remove_prefix(1);  // the slash that begins each segment
        const auto end = path.find('/');
        segments.emplace_back(path.substr(0, end));
        path = end == std::string_view::npos ? std::string_view() : path.substr(end);
    }
    return segments;
}

std::optional<PathValues> match(const std::vector<std::string>& pattern,
                                const std::vector<std::string>& segments) {
    if (pattern.size() != segments.size()) return std::nullopt;
    PathValues values;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] == "{}")
            values.push_back(segments[i]);
        else if (pattern[i] != segments[i])
            return std::nullopt;
    }
    return values;
}

}  // namespace

void Router::add(std::string_view method, std::string_view pattern, Handler handler) {
    routes_.push_back({std::string(method), segments_of(pattern), std::move(handler)});
}

Reply Router::handle(const Request& request) const {
    const std::string method = request.method == "HEAD" ? "GET" : request.method;
    const auto segments = segments_of(request.path);
    std::string allowed;
    for (const Route& route : routes_) {
        const auto values = match(route.segments, segments);
        if (!values) continue;
        if (route.method == method) {
            try {
                return route.handler(request, *values);
            } catch (...) {
                return problem_reply(problem_of(std::current_exception()));
            }
        }
        allowed += (allowed.empty() ? "" : ", ") + route.method;
        if (route.method == "GET") allowed += ", HEAD";
    }
    if (allowed.empty())
        return problem_reply({404, "not_found", "there is nothing at this address", request.path});
    Reply reply = problem_reply({405, "method_not_allowed", "this address answers " + allowed, request.path});
    reply.headers.emplace_back("Allow", allowed);
    return reply;
}

}  // namespace afterglow
