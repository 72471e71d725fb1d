#include <algorithm>

#include "service/api/routes.h"
#include "service/jobs/job_json.h"
#include "service/jobs/settings.h"

namespace afterglow {

namespace {

constexpr const char* body_name = "request";  // stands for the body in messages

/// What is found wrong with a job's scene or paths is said of the field that names them.
World world_of(const RouteContext& context, const JobRequest& request) {
    if (!context.scenes.find(request.scene))
        throw Error(ErrorKind::not_found, "request#/scene", "there is no such scene; upload it again");
    if (!request.paths.empty() && !context.scenes.has_paths(request.paths))
        throw Error(ErrorKind::not_found, "request#/paths", "there are no such paths; upload them again");
    return context.scenes.world(request.scene, request.paths, request.settings.background);
}

void check_camera(const World& world, const std::string& name) {
    if (name.empty()) return;
    std::string names;
    for (const PlacedCamera& placed : world.cameras) {
        if (placed.camera.name == name) return;
        names += (names.empty() ? "" : ", ") + placed.camera.name;
    }
    throw Error(ErrorKind::not_found, "request#/settings/camera", "no such camera; there are: " + names);
}

FrameRange frames_of(const World& world, const JobSettings& settings, const Limits& limits) {
    const FrameRange frames =
        settings.frames.value_or(FrameRange{0, last_frame_of(world, settings.sequence)});
    if (frames.last - frames.first >= limits.frames)
        throw Error(ErrorKind::too_large, "request#/settings/frames",
                    "the animation has more frames than the limit of " + std::to_string(limits.frames));
    return frames;
}

Reply post_job(const RouteContext& context, const Request& http_request) {
    const Json body = json_body(http_request, context.limits.request_bytes);
    const JobRequest request = read_job_request(JsonView(body, body_name), context.limits);
    const World world = world_of(context, request);
    check_camera(world, request.settings.sequence.camera);

    Job draft;
    draft.scene = request.scene;
    draft.paths = request.paths;
    draft.settings = request.settings;
    draft.frames = frames_of(world, request.settings, context.limits);
    draft.warnings = world.warnings;
    const Job job = context.jobs.add(std::move(draft));
    context.worker.submit(job.id);
    Reply reply = json_reply(to_json(job), 201);
    reply.headers.emplace_back("Location", "/v1/jobs/" + job.id);
    return reply;
}

Reply get_jobs(const RouteContext& context) {
    Json jobs = Json::array();
    for (const Job& job : context.jobs.list()) jobs.push_back(to_json(job));
    return json_reply({{"jobs", std::move(jobs)}});
}

Reply cancel_job(const RouteContext& context, const std::string& id) {
    const Job before = job_at(context.jobs, id);
    if (!context.worker.cancel(id))
        throw ProblemError({409, "job_ended",
                            "the job has ended: " + std::string(name_of(job_at(context.jobs, id).state)),
                            before.id});
    return json_reply(to_json(job_at(context.jobs, id)));
}

}  // namespace

Job job_at(const JobStore& jobs, const std::string& id) {
    if (auto job = jobs.find(id)) return *std::move(job);
    throw ProblemError({404, "not_found", "there is no such job", id});
}

Json json_body(const Request& request, std::size_t max_bytes) {
    if (request.media_type() != "application/json")
        throw ProblemError({415, "unsupported_media_type", "expected application/json", "Content-Type"});
    if (request.body.size() > max_bytes)
        throw ProblemError(
            {413, "too_large", "the body is longer than " + std::to_string(max_bytes) + " bytes", body_name});
    try {
        return parse_json(request.body, body_name);
    } catch (const Error& e) {
        throw ProblemError({400, "malformed_json", e.message(), e.place()});
    }
}

void add_job_routes(Router& router, const RouteContext& context) {
    router.add("POST", "/v1/jobs",
               [context](const Request& request, const PathValues&) { return post_job(context, request); });
    router.add("GET", "/v1/jobs", [context](const Request&, const PathValues&) { return get_jobs(context); });
    router.add("GET", "/v1/jobs/{}", [context](const Request&, const PathValues& values) {
        return json_reply(to_json(job_at(context.jobs, values[0])));
    });
    router.add("POST", "/v1/jobs/{}/cancel", [context](const Request&, const PathValues& values) {
        return cancel_job(context, values[0]);
    });
}

}  // namespace afterglow
