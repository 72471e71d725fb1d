#include <map>
#include <sstream>

#include "service/api/api_files.h"
#include "service/api/routes.h"

namespace afterglow {

namespace {

/// Whether work can be taken: the database answers and can be written.
Reply get_ready(Database& database) {
    try {
        database.change("UPDATE probe SET number = number + 1");
    } catch (const Error&) {
        Problem problem = problem_of(std::current_exception());
        problem.status = 503;
        return problem_reply(problem);
    }
    return json_reply({{"status", "ready"}});
}

/// Prometheus text format 0.0.4.
Reply get_metrics(const RouteContext& context) {
    JobStore::Counts counts = context.jobs.counts();
    for (const JobState state : all_job_states) counts.jobs.try_emplace(state, 0);
    std::ostringstream text;
    text << "# HELP afterglow_jobs Jobs by state.\n# TYPE afterglow_jobs gauge\n";
    for (const auto& [state, count] : counts.jobs)
        text << "afterglow_jobs{state=\"" << name_of(state) << "\"} " << count << "\n";
    text << "# HELP afterglow_frames Finished frames of the jobs that are kept.\n"
            "# TYPE afterglow_frames gauge\nafterglow_frames "
         << counts.frames
         << "\n# HELP afterglow_streams Streams that are open.\n# TYPE afterglow_streams gauge\n"
         << "afterglow_streams " << context.usage.open_streams() << "\n";
    return {200, "text/plain; version=0.0.4", text.str(), {{"Cache-Control", "no-store"}}, nullptr};
}

}  // namespace

void add_status_routes(Router& router, const RouteContext& context, Database& database) {
    router.add("GET", "/healthz", [](const Request&, const PathValues&) {
        return json_reply({{"status", "ok"}});
    });
    router.add("GET", "/readyz",
               [&database](const Request&, const PathValues&) { return get_ready(database); });
    router.add("GET", "/v1/openapi.json",
               [](const Request& request, const PathValues&) { return file_reply(request, api_files()[0]); });
    router.add("GET", "/metrics",
               [context](const Request&, const PathValues&) { return get_metrics(context); });
}

}  // namespace afterglow
