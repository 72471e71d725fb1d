#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>

#include "service/api/job_wait.h"
#include "service/api/routes.h"
#include "service/base/identity.h"
#include "service/base/option_values.h"
#include "service/jobs/job_json.h"
#include "service/jobs/settings.h"

namespace afterglow {

namespace {

constexpr const char* body_name = "request";  // stands for the body in messages

/// What is found wrong with a job's scene or paths is said of the field that names them.
SceneSurvey survey_of(const RouteContext& context, const JobRequest& request) {
    if (!context.scenes.find(request.scene) || !context.scenes.ask_for(request.scene))
        throw Error(ErrorKind::not_found, "request#/scene", "there is no such scene; upload it again");
    if (!request.paths.empty() &&
        (!context.scenes.has_paths(request.paths) || !context.scenes.ask_for(request.paths)))
        throw Error(ErrorKind::not_found, "request#/paths", "there are no such paths; upload them again");
    return context.scenes.survey(request.scene, request.paths, request.settings.background,
                                 request.settings.sequence.frames_per_second);
}

void check_camera(const std::vector<std::string>& cameras, const std::string& name) {
    if (name.empty()) return;
    std::string names;
    for (const std::string& camera : cameras) {
        if (camera == name) return;
        names += (names.empty() ? "" : ", ") + camera;
    }
    throw Error(ErrorKind::not_found, "request#/settings/camera", "no such camera; there are: " + names);
}

FrameRange frames_of(const SceneSurvey& survey, const JobSettings& settings, const Limits& limits) {
    const FrameRange frames = settings.frames.value_or(FrameRange{0, survey.last_frame});
    if (frames.last - frames.first >= limits.frames)
        throw Error(ErrorKind::too_large, "request#/settings/frames",
                    "the animation has more frames than the limit of " + std::to_string(limits.frames));
    return frames;
}

/// What the client's token allows; only the number of jobs gets better by waiting.
void check_quota(const RouteContext& context, const Client& client, const Job& draft) {
    const auto refuse = [](const char* field, const std::string& what, std::int64_t limit) {
        throw Error(ErrorKind::too_large, std::string("request#/settings/") + field,
                    "more " + what + " than the quota of " + std::to_string(limit));
    };
    const SequenceConfig& config = draft.settings.sequence;
    if (draft.frame_count() > client.quota.frames) refuse("frames", "frames", client.quota.frames);
    if (std::int64_t{config.width} * config.height > client.quota.pixels)
        refuse("width", "pixels", client.quota.pixels);
    check_unfinished(context, client, draft);
}

std::string read_idempotency_key(const Request& request) {
    std::string key = request.header("idempotency-key");
    if (key.size() > 255) throw Error(ErrorKind::invalid_input, "Idempotency-Key", "longer than 255 bytes");
    return key;
}

Reply made_reply(const Job& job) {
    Reply reply = job_reply(job, 201);
    reply.headers.emplace_back("Location", "/v1/jobs/" + job.id);
    return reply;
}

Reply post_job(const RouteContext& context, const Request& http_request) {
    const std::string key = read_idempotency_key(http_request);
    const Json body = json_body(http_request, context.limits.request_bytes);
    const JobRequest request = read_job_request(JsonView(body, body_name), context.limits);
    const SceneSurvey survey = survey_of(context, request);
    check_camera(survey.cameras, request.settings.sequence.camera);

    Job draft;
    draft.scene = request.scene;
    draft.paths = request.paths;
    draft.settings = request.settings;
    draft.frames = frames_of(survey, request.settings, context.limits);
    const double asked = request.settings.sequence.frames_per_second;
    draft.frames_per_second = asked > 0 ? asked : survey.frames_per_second;
    draft.warnings = survey.warnings;
    draft.owner = http_request.client.name;
    draft.idempotency_key = key;
    draft.idempotency_hash = key.empty() ? "" : sha256(http_request.body);
    if (const auto known = context.jobs.repeated(draft)) return made_reply(*known);
    check_quota(context, http_request.client, draft);
    const Job job = context.jobs.add(std::move(draft));
    if (job.state == JobState::queued && !job.started) context.worker.submit(job.id);
    return made_reply(job);
}

std::optional<JobState> read_state(const std::string& text) {
    if (text.empty()) return std::nullopt;
    for (const JobState state : all_job_states)
        if (text == name_of(state)) return state;
    throw Error(ErrorKind::invalid_input, "request?state", "there is no state \"" + text + "\"");
}

/// Newest first; `next` is the cursor of what comes after, where anything does.
Reply get_jobs(const RouteContext& context, const Request& request) {
    const auto state = read_state(request.parameter("state"));
    const std::string limit_text = request.parameter("limit");
    const auto limit = limit_text.empty()
                           ? std::numeric_limits<std::size_t>::max() - 1
                           : static_cast<std::size_t>(whole_number("request?limit", limit_text, 1, 10'000));
    // One more than asked for tells whether anything comes after.
    const auto jobs = context.jobs.list({request.parameter("cursor"), state, limit + 1});
    if (!jobs) throw ProblemError({410, "gone", "this cursor is known no longer", "request?cursor"});
    Json page = Json::array();
    for (std::size_t i = 0; i < std::min(jobs->size(), limit); ++i) page.push_back(to_json((*jobs)[i]));
    const Json next = jobs->size() > limit ? page.back().at("id") : Json(nullptr);
    return json_reply({{"jobs", std::move(page)}, {"next", next}});
}

/// With `wait`, once the job has ended, or after as long as asked.
Reply get_job(const RouteContext& context, const Request& request, const std::string& id) {
    Job job = job_at(context.jobs, id);
    const std::string text = request.parameter("wait");
    if (text.empty()) return job_reply(job);
    const std::chrono::seconds longest(whole_number("request?wait", text, 0, 60));
    Reply reply = job_reply(job);
    reply.body.clear();
    reply.stream = context.usage.counted(
        request.client,
        std::make_shared<JobWait>(context.jobs, std::move(job), events_at(context.jobs, id), longest));
    return reply;
}

/// A change of state that the client asks for: 409 where the job's state does not allow it.
Reply change_job(const RouteContext& context, const Request& request, const std::string& id,
                 const std::function<bool()>& change) {
    own_job_at(context.jobs, request, id);
    if (change()) return job_reply(job_at(context.jobs, id));
    const JobState state = job_at(context.jobs, id).state;
    throw ProblemError({409, has_ended(state) ? "job_ended" : "illegal_transition",
                        "not possible for a job that is " + std::string(name_of(state)), id});
}

/// The only thing of a job that a client may set anew is how it stands among others.
Reply patch_job(const RouteContext& context, const Request& request, const std::string& id) {
    const Json body = json_body(request, context.limits.request_bytes, "application/merge-patch+json");
    const auto priority = read_priority(JsonView(body, body_name));
    return change_job(context, request, id,
                      [&] { return !priority || context.worker.set_priority(id, *priority); });
}

bool resume(const RouteContext& context, const std::string& id) {
    if (has_ended(job_at(context.jobs, id).state) || !context.jobs.requeue(id)) return false;
    context.worker.submit(id);
    return true;
}

bool retry(const RouteContext& context, const Client& client, const std::string& id) {
    const Job job = job_at(context.jobs, id);
    if (!has_ended(job.state) || !may_follow(job.state, JobState::queued)) return false;
    check_unfinished(context, client, job);
    if (!context.jobs.requeue(id)) return false;
    context.worker.submit(id);
    return true;
}

/// Removes an ended job with its pictures, or tells what that would free.
Reply delete_job(const RouteContext& context, const Request& request, const std::string& id) {
    const Job job = own_job_at(context.jobs, request, id);
    const std::string dry = request.parameter("dry_run");
    if (!dry.empty() && dry != "0" && dry != "1")
        throw Error(ErrorKind::invalid_input, "request?dry_run", "expected 0 or 1");
    const Json freed = {{"id", id},
                        {"frames", job.frames_done},
                        {"bytes", context.frames.bytes_of(id)},
                        {"removed", dry != "1"}};
    if (!has_ended(job.state))
        throw ProblemError(
            {409, "illegal_transition", "only a job that has ended can be removed; cancel it first", id});
    if (dry != "1") {
        context.frames.flush();
        if (!context.jobs.remove(id))
            throw ProblemError({409, "illegal_transition", "the job goes on again", id});
        context.frames.remove(id);
    }
    return json_reply(freed);
}

}  // namespace

void check_unfinished(const RouteContext& context, const Client& client, const Job& job) {
    if (job.owner != client.name) return;
    std::int64_t unfinished = 0;
    for (const Job& one : context.jobs.unended())
        if (one.owner == client.name) ++unfinished;
    if (unfinished >= client.quota.jobs) throw past_quota("jobs", client.quota.jobs);
}

Job own_job_at(const JobStore& jobs, const Request& request, const std::string& id) {
    Job job = job_at(jobs, id);
    if (request.client.role == Role::admin || job.owner == request.client.name) return job;
    throw ProblemError({403, "not_yours", "this job is another client's", id});
}

Reply job_reply(const Job& job, int status) {
    Reply reply = json_reply(to_json(job), status);
    reply.headers.emplace_back("ETag", "\"" + std::to_string(job.revision()) + "\"");
    return reply;
}

Job job_at(const JobStore& jobs, const std::string& id) {
    if (auto job = jobs.find(id)) return *std::move(job);
    throw ProblemError({404, "not_found", "there is no such job", id});
}

std::shared_ptr<const EventLog> events_at(const JobStore& jobs, const std::string& id) {
    if (auto log = jobs.events(id)) return log;
    throw ProblemError({404, "not_found", "there is no such job", id});
}

Json json_body(const Request& request, std::size_t max_bytes, const std::string& media_type) {
    if (request.media_type() != media_type)
        throw ProblemError({415, "unsupported_media_type", "expected " + media_type, "Content-Type"});
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
    router.add("GET", "/v1/jobs",
               [context](const Request& request, const PathValues&) { return get_jobs(context, request); });
    router.add("GET", "/v1/jobs/{}", [context](const Request& request, const PathValues& values) {
        return get_job(context, request, values[0]);
    });
    router.add("PATCH", "/v1/jobs/{}", [context](const Request& request, const PathValues& values) {
        return patch_job(context, request, values[0]);
    });
    router.add("DELETE", "/v1/jobs/{}", [context](const Request& request, const PathValues& values) {
        return delete_job(context, request, values[0]);
    });
    const auto add_change = [&](const std::string& name,
                                const std::function<bool(const Client&, const std::string&)>& change) {
        router.add("POST", "/v1/jobs/{}/" + name,
                   [context, change](const Request& request, const PathValues& values) {
                       return change_job(context, request, values[0],
                                         [&] { return change(request.client, values[0]); });
                   });
    };
    add_change("cancel",
               [context](const Client&, const std::string& id) { return context.worker.cancel(id); });
    add_change("pause", [context](const Client&, const std::string& id) { return context.worker.pause(id); });
    add_change("resume", [context](const Client&, const std::string& id) { return resume(context, id); });
    add_change("retry",
               [context](const Client& client, const std::string& id) { return retry(context, client, id); });
}

}  // namespace afterglow
