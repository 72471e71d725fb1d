#include "service/api/service.h"

#include <system_error>
#include <utility>
#include <vector>

#include "service/api/routes.h"
#include "service/viewer/viewer_routes.h"

namespace afterglow {

namespace {

// Ids of events begin anew in each life of the service, above all of earlier ones.
constexpr std::uint64_t events_of_a_life = 1'000'000'000;

const std::filesystem::path& made(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(ErrorKind::io, folder.string(), error.message());
    return folder;
}

std::uint64_t first_event_of(const Database& database) {
    return static_cast<std::uint64_t>(database.openings() - 1) * events_of_a_life;
}

EncoderEvents tell(JobStore& jobs) {
    return {[&jobs](const std::string& job, const FrameInfo& info) { jobs.note_picture(job, info); },
            [&jobs](const std::string& job, const std::exception_ptr& failure) {
                jobs.end(job, JobState::failed, problem_of(failure));
            }};
}

}  // namespace

Service::Service(const ServiceConfig& config, ServiceParts parts)
    : at_stop_(config.at_stop),
      database_(made(config.data_folder) / "service.db"),
      job_table_(database_),
      jobs_({{}, JobStoreConfig{}.progress_interval, first_event_of(database_)}, &job_table_,
            durable_frames(database_)),
      journal_(database_,
               [this](const FrameJournal::Entry& entry, const std::exception_ptr& failure) {
                   jobs_.forget_picture(entry.job, entry.info.frame);
                   jobs_.end(entry.job, JobState::failed, problem_of(failure));
               }),
      scenes_(config.data_folder / "uploads", std::move(parts.read_scene), &database_),
      frames_(config.data_folder / "jobs", &journal_),
      encoder_(frames_, tell(jobs_)),
      worker_(jobs_, encoder_,
              parts.make_run ? std::move(parts.make_run) : solver_runs(scenes_, config.data_folder / "cache"),
              {config.threads, config.max_resident}) {
    const RouteContext context{scenes_, jobs_, frames_, worker_, config.limits, usage_};
    add_status_routes(router_, context, database_);
    add_scene_routes(router_, context);
    add_job_routes(router_, context);
    add_frame_routes(router_, context);
    add_stream_routes(router_, context);
    add_viewer_routes(router_);
    const std::vector<Job> known = jobs_.list();
    for (auto job = known.rbegin(); job != known.rend(); ++job)
        if (job->state == JobState::queued) worker_.submit(job->id);
}

Service::~Service() {
    stop();
}

void Service::stop() {
    if (at_stop_ == ServiceConfig::AtStop::cancel)
        for (const Job& job : jobs_.list()) worker_.cancel(job.id);
    worker_.halt();
    jobs_.close_streams();
}

}  // namespace afterglow
