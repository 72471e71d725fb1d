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

JobStoreConfig config_of(const ServiceConfig& config, const Database& database,
                         std::function<void(const std::string&)> at_rest) {
    JobStoreConfig jobs;
    jobs.first_event = static_cast<std::uint64_t>(database.openings() - 1) * events_of_a_life;
    jobs.ended_in_memory = config.ended_in_memory;
    jobs.at_rest = std::move(at_rest);
    return jobs;
}

EncoderEvents tell(JobStore& jobs, FrameStore& frames) {
    return {[&jobs, &frames](const std::string& job, const FrameInfo& info) {
                jobs.note_picture(job, info);
                // It may have been removed while its picture was being written.
                if (!jobs.find(job)) frames.remove(job);
            },
            [&jobs](const std::string& job, const std::exception_ptr& failure) {
                jobs.end(job, JobState::failed, problem_of(failure));
            }};
}

}  // namespace

Service::Service(const ServiceConfig& config, ServiceParts parts)
    : at_stop_(config.at_stop),
      readers_(std::make_shared<ReaderChildren>(config.survey)),
      database_(made(config.data_folder) / "service.db"),
      job_table_(database_),
      jobs_(config_of(config, database_, [this](const std::string& job) { frames_.rest(job); }), &job_table_),
      journal_(database_,
               [this](const FrameJournal::Entry& entry, const std::exception_ptr& failure) {
                   jobs_.forget_picture(entry.job, entry.info.frame);
                   jobs_.end(entry.job, JobState::failed, problem_of(failure));
               }),
      scenes_(config.data_folder / "uploads",
              parts.read_scene ? surveys_here(parts.read_scene) : surveys_in_children(readers_), &database_,
              parts.read_scene ? parts.read_scene : usual_reader()),
      blobs_(config.data_folder / "blobs", config.limits.blob_bytes),
      frames_(config.data_folder / "jobs", &journal_),
      encoder_(frames_, tell(jobs_, frames_)),
      worker_(
          jobs_, encoder_,
          parts.make_run
              ? std::move(parts.make_run)
              : child_runs(scenes_,
                           {config.data_folder / "cache", {config.job_memory, {}}, config.survey.program}),
          {config.threads, config.max_resident}),
      retention_(jobs_, frames_, scenes_, blobs_, config.data_folder / "cache", config.retention) {
    const RouteContext context{
        scenes_, blobs_,
        jobs_,   frames_,
        worker_, config.limits,
        usage_,  parts.read_scene ? Unpacker(unpack_here) : unpacks_in_children(readers_)};
    add_status_routes(router_, context, database_);
    add_scene_routes(router_, context);
    add_blob_routes(router_, context);
    add_job_routes(router_, context);
    add_edit_routes(router_, context);
    add_frame_routes(router_, context);
    add_stream_routes(router_, context);
    add_viewer_routes(router_);
    for (const Job& job : jobs_.unended())
        if (job.state == JobState::queued) worker_.submit(job.id);
}

Service::~Service() {
    stop();
}

BodyCheck Service::body_check() {
    return [this](const Request& request, std::size_t bytes) -> std::optional<Reply> {
        if (request.path != "/v1/scenes" && request.path != "/v1/paths") return std::nullopt;
        try {
            usage_.check_bytes(request.client, bytes);
        } catch (const ProblemError& e) {
            return problem_reply(e.problem());
        }
        return std::nullopt;
    };
}

void Service::stop() {
    if (at_stop_ == ServiceConfig::AtStop::cancel)
        for (const Job& job : jobs_.unended()) worker_.cancel(job.id);
    worker_.halt();
    jobs_.close_streams();
}

}  // namespace afterglow
