#include "client/problem.h"

#include "client/text.h"

namespace afterglow::client {

std::string problem_line(const Json& problem) {
    std::string line = find_string(problem, "place").value_or("");
    const auto detail = find_string(problem, "detail");
    const auto title = find_string(problem, "title");
    const std::string what = detail ? *detail : title.value_or("no reason given");
    // A detail may already begin with its place, as error texts of the form "place: message" do.
    if (line.empty() || what.starts_with(line + ": ")) return one_line(what);
    return one_line(line + ": " + what);
}

ClientError error_of(const HttpReply& reply, const std::string& server, NotFound not_found) {
    const bool is_problem = reply.header("Content-Type").starts_with("application/problem+json");
    if (!is_problem)
        return {ExitCode::no_server, server,
                "replied with HTTP status " + std::to_string(reply.status) + " and no explanation"};
    ExitCode code = reply.status < 500 ? ExitCode::bad_input : ExitCode::no_server;
    if (reply.status == 404 && not_found == NotFound::not_found) code = ExitCode::not_found;
    return {code, "", problem_line(parse_json(reply.body, server))};
}

Json json_reply(const HttpReply& reply, const std::string& server, NotFound not_found) {
    if (reply.status < 200 || reply.status > 299) throw error_of(reply, server, not_found);
    Json body = parse_json(reply.body, server);
    if (!body.is_object()) throw ClientError(ExitCode::no_server, server, "sent a reply that is no object");
    return body;
}

}  // namespace afterglow::client
