#include "service/http/gate.h"

#include <algorithm>
#include <arpa/inet.h>
#include <cctype>
#include <string_view>

namespace afterglow {

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// A host without its port and brackets.
std::string name_of_host(const std::string& host) {
    if (host.starts_with('[')) return host.substr(1, host.find(']') - 1);
    return lower(host.substr(0, host.find(':')));
}

bool is_ip_address(const std::string& name) {
    in6_addr parsed{};
    return ::inet_pton(AF_INET, name.c_str(), &parsed) == 1 ||
           ::inet_pton(AF_INET6, name.c_str(), &parsed) == 1;
}

bool is_read_only(const std::string& method) {
    return method == "GET" || method == "HEAD" || method == "OPTIONS";
}

/// What is answered without a token: whether the service lives, and the page that asks for the token.
bool is_public(const Request& request) {
    return is_read_only(request.method) && request.path != "/metrics" && !request.path.starts_with("/v1/");
}

std::optional<Problem> problem_of_host(const Request& request, const std::vector<std::string>& hosts) {
    const std::string name = name_of_host(request.header("host"));
    const bool known = name == "localhost" || is_ip_address(name) ||
                       std::find(hosts.begin(), hosts.end(), name) != hosts.end();
    if (known) return std::nullopt;
    return Problem{421, "host_not_allowed", "this service is not reached by that name; see serve --host",
                   "Host"};
}

std::optional<Problem> problem_of_origin(const Request& request) {
    const Problem refused{403, "origin_not_allowed", "pages of other sites may not use this service",
                          "Origin"};
    if (const std::string origin = lower(request.header("origin")); !origin.empty()) {
        const std::string host = lower(request.header("host"));
        if (origin != "http://" + host && origin != "https://" + host) return refused;
    }
    // Pictures and frames of other sites come without an Origin; following a link is no harm.
    const std::string site = request.header("sec-fetch-site");
    const bool is_foreign = site == "cross-site" || site == "same-site";
    const bool is_visit = request.header("sec-fetch-mode") == "navigate" && is_read_only(request.method);
    if (is_foreign && !is_visit) return refused;
    return std::nullopt;
}

std::string token_of(const Request& request) {
    constexpr std::string_view scheme = "bearer ";
    const std::string authorization = request.header("authorization");
    if (lower(authorization.substr(0, scheme.size())) == scheme) return authorization.substr(scheme.size());
    constexpr std::string_view cookie = "afterglow_token=";
    const std::string cookies = "; " + request.header("cookie");
    const auto at = cookies.find("; " + std::string(cookie));
    if (at == std::string::npos) return {};
    const auto begin = at + 2 + cookie.size();
    return cookies.substr(begin, cookies.find(';', begin) - begin);
}

Reply unauthorized() {
    Reply reply = problem_reply(
        {401, "token_needed", "a token is needed: Authorization: Bearer TOKEN", "Authorization"});
    reply.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"afterglow\"");
    return reply;
}

}  // namespace

bool is_loopback(const std::string& address) {
    in_addr four{};
    if (::inet_pton(AF_INET, address.c_str(), &four) == 1) return (ntohl(four.s_addr) >> 24U) == 127;
    return address == "::1" || lower(address) == "localhost";
}

Gate make_gate(GateConfig config) {
    for (std::string& host : config.hosts) host = lower(host);
    return [config = std::move(config)](Request& request) -> std::optional<Reply> {
        if (auto problem = problem_of_host(request, config.hosts)) return problem_reply(*problem);
        if (auto problem = problem_of_origin(request)) return problem_reply(*problem);
        if (!config.tokens) return std::nullopt;
        auto client = config.tokens->find(token_of(request));
        if (!client) return is_public(request) ? std::nullopt : std::optional(unauthorized());
        request.client = *std::move(client);
        if (request.client.role == Role::viewer && !is_read_only(request.method))
            return problem_reply({403, "role_too_low", "this token may only look", "Authorization"});
        return std::nullopt;
    };
}

}  // namespace afterglow
