#include <chrono>
#include <ostream>

#include "client/commands.h"
#include "client/error.h"
#include "client/movie.h"
#include "client/problem.h"
#include "client/text.h"

namespace afterglow::client {

namespace {

/// What was looked at, how it is, and what to do where it is not well.
struct Finding {
    enum class Mark { well, note, broken } mark = Mark::well;
    std::string subject;
    std::string text;
};

std::string_view name_of(Finding::Mark mark) {
    switch (mark) {
        case Finding::Mark::well:
            return "ok";
        case Finding::Mark::note:
            return "note";
        case Finding::Mark::broken:
            return "broken";
    }
    return "";
}

Finding check_server(HttpConnection& connection) {
    const auto begin = std::chrono::steady_clock::now();
    try {
        const HttpReply reply = connection.get("/healthz");
        if (reply.status != 200) throw error_of(reply, connection.server(), NotFound::not_found);
    } catch (const ClientError& error) {
        if (error.code() == ExitCode::interrupted) throw;
        return {Finding::Mark::broken, "server",
                std::string(error.what()) + "; is `afterglowd serve` running there? --server names another"};
    }
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
    return {
        Finding::Mark::well, "server",
        connection.server() + " answers in " + std::to_string(static_cast<int>(taken.count()) + 1) + " ms"};
}

Finding check_access(HttpConnection& connection, const std::string& token) {
    const HttpReply reply = connection.get("/v1/jobs");
    if (reply.status == 200)
        return {Finding::Mark::well, "access", token.empty() ? "without a token" : "with the token"};
    if (reply.status == 401 && token.empty())
        return {Finding::Mark::note, "access", "the server wants a token: --token-file, or AFTERGLOW_TOKEN"};
    return {Finding::Mark::broken, "access",
            error_of(reply, connection.server(), NotFound::not_found).what()};
}

Finding check_movies() {
    if (find_movie_maker() == MovieMaker::present) return {Finding::Mark::well, "movies", "ffmpeg is there"};
    return {Finding::Mark::note, "movies", "`get --movie` needs ffmpeg, which is not there"};
}

}  // namespace

ExitCode run_doctor(const Session& session) {
    HttpConnection connection = connect(session);
    std::vector<Finding> findings{check_server(connection)};
    if (findings.back().mark == Finding::Mark::well)
        findings.push_back(check_access(connection, session.options.token));
    findings.push_back(check_movies());

    ExitCode code = ExitCode::ok;
    for (const Finding& finding : findings) {
        if (finding.mark == Finding::Mark::broken) code = ExitCode::no_server;
        if (session.options.format == OutputFormat::json)
            session.out << to_line(
                {{"check", finding.subject}, {"result", name_of(finding.mark)}, {"text", finding.text}});
        else
            session.out << name_of(finding.mark) << std::string(8 - name_of(finding.mark).size(), ' ')
                        << finding.subject << ": " << one_line(finding.text);
        session.out << '\n';
    }
    return code;
}

}  // namespace afterglow::client
