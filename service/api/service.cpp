#include "service/api/service.h"

#include <utility>

#include "service/api/routes.h"
#include "service/viewer/viewer_routes.h"

namespace afterglow {

namespace {

EncoderEvents tell(JobStore& jobs) {
    return {[&jobs](const std::string& job, const FrameInfo& info) { jobs.note_picture(job, info); },
            [&jobs](const std::string& job, const std::exception_ptr& failure) {
                jobs.end(job, JobState::failed, problem_of(failure));
            }};
}

}  // namespace

Service::Service(const ServiceConfig& config, ServiceParts parts)
    : scenes_(config.data_folder / "uploads", std::move(parts.read_scene)),
      frames_(config.data_folder / "jobs"),
      encoder_(frames_, tell(jobs_)),
      worker_(jobs_, encoder_,
              parts.make_run ? std::move(parts.make_run) : solver_runs(scenes_, config.data_folder / "cache"),
              {config.threads, config.max_resident}) {
    const RouteContext context{scenes_, jobs_, frames_, worker_, config.limits};
    router_.add("GET", "/healthz", [](const Request&, const PathValues&) {
        return json_reply({{"status", "ok"}});
    });
    add_scene_routes(router_, context);
    add_job_routes(router_, context);
    add_frame_routes(router_, context);
    add_stream_routes(router_, context);
    add_viewer_routes(router_);
}

Service::~Service() {
    stop();
}

void Service::stop() {
    for (const Job& job : jobs_.list()) worker_.cancel(job.id);
}

}  // namespace afterglow
