#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>

#include "service/api/routes.h"
#include "service/base/identity.h"
#include "service/base/option_values.h"
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
    std::int64_t active = 0;
    for (const Job& job : context.jobs.list())
        if (job.owner == client.name && !has_ended(job.state)) ++active;
    if (active >= client.quota.jobs) throw past_quota("jobs", client.quota.jobs);
}

std::string read_idempotency_key(const Request& request) {
    const std::string key = request.header("idempotency-key");
    if (key.size() > 255) throw Error(ErrorKind::invalid_input, "Idempotency-Key", "longer than 255 bytes");
    return key;
}

Reply made_reply(const Job& job) {
    Reply reply = json_reply(to_json(job), 201);
    reply.headers.emplace_back("Location", "/v1/jobs/" + job.id);
    return reply;
}

Reply post_job(const RouteContext& context, const Request& http_request) {
    const std::string key = read_idempotency_key(http_request);
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
    const auto limit = limit_text.empty() ? std::numeric_limits<std::int64_t>::max()
                                          : whole_number("request?limit", limit_text, 1, 10'000);
    const std::string cursor = request.parameter("cursor");
    const std::vector<Job> all = context.jobs.list();
    auto job = all.begin();
    if (!cursor.empty()) {
        job = std::find_if(all.begin(), all.end(), [&](const Job& one) { return one.id == cursor; });
        if (job == all.end())
            throw ProblemError({410, "gone", "this cursor is known no longer", "request?cursor"});
        ++job;
    }
    Json page = Json::array();
    Json next = nullptr;
    for (; job != all.end(); ++job) {
        if (state && job->state != *state) continue;
        if (static_cast<std::int64_t>(page.size()) == limit) {
            next = page.back().at("id");
            break;
        }
        page.push_back(to_json(*job));
    }
    return json_reply({{"jobs", std::move(page)}, {"next", std::move(next)}});
}

/// Waits until the job ends, at most as long as asked.
Reply get_job(const RouteContext& context, const Request& request, const std::string& id) {
    job_at(context.jobs, id);
    if (const std::string text = request.parameter("wait"); !text.empty()) {
        const auto give_up = std::chrono::steady_clock::now() +
                             std::chrono::seconds(whole_number("request?wait", text, 0, 60));
        const auto log = events_at(context.jobs, id);
        auto reached = log->last_id();
        while (!has_ended(job_at(context.jobs, id).state)) {
            const auto left =
                std::chrono::ceil<std::chrono::milliseconds>(give_up - std::chrono::steady_clock::now());
            if (left.count() <= 0) break;
            if (log->wait_after(reached, left).status == EventLog::Status::ended) break;
            reached = log->last_id();
        }
    }
    return json_reply(to_json(job_at(context.jobs, id)));
}

/// A change of state that the client asks for: 409 where the job's state does not allow it.
Reply change_job(const RouteContext& context, const Request& request, const std::string& id,
                 const std::function<bool()>& change) {
    own_job_at(context.jobs, request, id);
    if (change()) return json_reply(to_json(job_at(context.jobs, id)));
    const JobState state = job_at(context.jobs, id).state;
    throw ProblemError({409, has_ended(state) ? "job_ended" : "illegal_transition",
                        "not possible for a job that is " + std::string(name_of(state)), id});
}

bool requeue_from(const RouteContext& context, const std::string& id, bool from_an_end) {
    const Job job = job_at(context.jobs, id);
    if (has_ended(job.state) != from_an_end || !context.jobs.requeue(id)) return false;
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

Job own_job_at(const JobStore& jobs, const Request& request, const std::string& id) {
    Job job = job_at(jobs, id);
    if (request.client.role == Role::admin || job.owner == request.client.name) return job;
    throw ProblemError({403, "not_yours", "this job is another client's", id});
}

Job job_at(const JobStore& jobs, const std::string& id) {
    if (auto job = jobs.find(id)) return *std::move(job);
    throw ProblemError({404, "not_found", "there is no such job", id});
}

std::shared_ptr<const EventLog> events_at(const JobStore& jobs, const std::string& id) {
    if (auto log = jobs.events(id)) return log;
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
    router.add("GET", "/v1/jobs",
               [context](const Request& request, const PathValues&) { return get_jobs(context, request); });
    router.add("GET", "/v1/jobs/{}", [context](const Request& request, const PathValues& values) {
        return get_job(context, request, values[0]);
    });
    router.add("DELETE", "/v1/jobs/{}", [context](const Request& request, const PathValues& values) {
        return delete_job(context, request, values[0]);
    });
    const auto add_change = [&](const std::string& name,
                                const std::function<bool(const std::string&)>& change) {
        router.add("POST", "/v1/jobs/{}/" + name,
                   [context, change](const Request& request, const PathValues& values) {
                       return change_job(context, request, values[0], [&] { return change(values[0]); });
                   });
    };
    add_change("cancel", [context](const std::string& id) { return context.worker.cancel(id); });
    add_change("pause", [context](const std::string& id) { return context.worker.pause(id); });
    add_change("resume", [context](const std::string& id) { return requeue_from(context, id, false); });
    add_change("retry", [context](const std::string& id) { return requeue_from(context, id, true); });
}

}  // namespace afterglow
