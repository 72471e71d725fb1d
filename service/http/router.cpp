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

std::vector<std::pair<std::string, std::string>> Router::routes() const {
    std::vector<std::pair<std::string, std::string>> all;
    for (const Route& route : routes_) {
        std::string pattern;
        for (const std::string& segment : route.segments) pattern += "/" + segment;
        all.emplace_back(route.method, pattern);
    }
    return all;
}

const Router::Route* Router::find(std::string_view method, const std::vector<std::string>& segments,
                                  PathValues& values) const {
    for (const Route& route : routes_) {
        if (route.method != method) continue;
        auto found = match(route.segments, segments);
        if (!found) continue;
        values = *std::move(found);
        return &route;
    }
    return nullptr;
}

std::string Router::allowed(const std::vector<std::string>& segments) const {
    std::string methods;
    for (const Route& route : routes_) {
        if (!match(route.segments, segments)) continue;
        methods += (methods.empty() ? "" : ", ") + route.method;
        if (route.method == "GET") methods += ", HEAD";
    }
    return methods;
}

Reply Router::handle(const Request& request) const {
    const auto segments = segments_of(request.path);
    PathValues values;
    const Route* route = find(request.method, segments, values);
    if (route == nullptr && request.method == "HEAD") route = find("GET", segments, values);
    if (route != nullptr) {
        try {
            return route->handler(request, values);
        } catch (...) {
            return problem_reply(problem_of(std::current_exception()));
        }
    }
    const std::string methods = allowed(segments);
    if (methods.empty())
        return problem_reply({404, "not_found", "there is nothing at this address", request.path});
    Reply reply = problem_reply({405, "method_not_allowed", "this address answers " + methods, request.path});
    reply.headers.emplace_back("Allow", methods);
    return reply;
}

}  // namespace afterglow
