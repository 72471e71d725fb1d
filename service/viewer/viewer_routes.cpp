#include "service/viewer/viewer_routes.h"

#include <algorithm>
#include <string>

#include "service/viewer/viewer_files.h"

namespace afterglow {

namespace {

// Nothing but what this server sends may run or be loaded, whatever the name of a job or a scene holds. The
// server's own policy for data allows nothing at all.
constexpr auto content_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

Reply get_file(const Request& request, std::string_view name) {
    const auto files = viewer_files();
    const auto found = std::ranges::find(files, name, &EmbeddedFile::name);
    if (found == files.end()) throw ProblemError({404, "not_found", "no such file", std::string(name)});
    Reply reply = file_reply(request, *found);
    reply.headers.emplace_back("Content-Security-Policy", content_policy);
    return reply;
}

}  // namespace

void add_viewer_routes(Router& router) {
    router.add("GET", "/",
               [](const Request& request, const PathValues&) { return get_file(request, "index.html"); });
    router.add("GET", "/viewer/{}",
               [](const Request& request, const PathValues& values) { return get_file(request, values[0]); });
}

}  // namespace afterglow
