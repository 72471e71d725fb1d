#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <optional>

#include "service/api/routes.h"
#include "service/jobs/edit_json.h"

namespace afterglow {

namespace {

constexpr int most_revisions = 1000;  // of a job

/// Whether a list of entity tags, or `*`, names this revision. Weak tags never do (RFC 9110, 13.1.1).
bool names_revision(std::string_view tags, int revision) {
    const std::string tag = "\"" + std::to_string(revision) + "\"";
    while (!tags.empty()) {
        const auto comma = std::min(tags.find(','), tags.size());
        std::string_view one = tags.substr(0, comma);
        tags.remove_prefix(std::min(comma + 1, tags.size()));
        while (one.starts_with(' ') || one.starts_with('\t')) one.remove_prefix(1);
        while (one.ends_with(' ') || one.ends_with('\t')) one.remove_suffix(1);
        if (one == tag || one == "*") return true;
    }
    return false;
}

ProblemError changed_since(const Job& job) {
    return ProblemError({412, "stale_revision",
                         "the job has revision " + std::to_string(job.revision()) +
                             " by now; look at it again before editing it",
                         "If-Match"});
}

void check_precondition(const Request& request, const Job& job) {
    const std::string tags = request.header("if-match");
    if (tags.empty())
        throw ProblemError({428, "revision_required",
                            "an edit needs If-Match with the ETag of the job that it is meant for",
                            "If-Match"});
    if (!names_revision(tags, job.revision())) throw changed_since(job);
}

void check_editable(const Job& job) {
    if (!may_be_edited(job.state))
        throw ProblemError(
            {409, "job_ended",
             "a job that is " + std::string(name_of(job.state)) + " cannot be edited; retry it", job.id});
    if (job.revision() >= most_revisions)
        throw ProblemError({409, "too_many_edits",
                            "the job was edited " + std::to_string(most_revisions) + " times; submit another",
                            job.id});
}

/// What is found wrong with an edit is said of the field that it is in.
Error at_field(const Error& error, const std::string& kind, std::size_t number) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 14> fields{
        {{"material", "material"},
         {"piece", "node"},
         {"actor", "node"},
         {"node", "node"},
         {"camera", "camera"},
         {"emission", "emission"},
         {"emission_scale", "emission_scale"},
         {"scale", "scale"},
         {"lamp", "lamp"},
         {"name", "name"},
         {"intensity", "intensity"},
         {"intensity_scale", "intensity_scale"},
         {"reflectance", "reflectance"},
         {"motion", "translation"}}};
    std::string place = "request#/edits/" + std::to_string(number) + "/" + kind;
    for (const auto& [known, field] : fields)
        if (error.place() == known) place += "/" + std::string(field);
    if (kind == "add" && error.place() == "material")
        place = place.substr(0, place.rfind('/')) + "/geometry/material";
    return {error.kind(), place, error.message()};
}

World uploaded_world(const RouteContext& context, const Job& job) {
    return context.scenes.world(job.scene, job.paths, job.settings.background);
}

World edited_world(const Job& job, World world) {
    for (const JobEdit& request : job.edits)
        for (const Edit& edit : request.edits) apply(world, edit);
    return world;
}

/// Tries the edits on the job's scene and settles what depends on it.
void try_edits(const RouteContext& context, const Job& job, std::vector<Edit>& edits) {
    const World uploaded = uploaded_world(context, job);
    World world = edited_world(job, uploaded);
    for (std::size_t k = 0; k < edits.size(); ++k) {
        try {
            resolve(edits[k], uploaded);
            apply(world, edits[k]);
            if (const auto* camera = std::get_if<CameraEdit>(&edits[k].what))
                static_cast<void>(camera_of(uploaded, job.settings.sequence.camera, *camera));
        } catch (const Error& e) {
            throw at_field(e, edits[k].source.begin().key(), k);
        }
    }
}

Reply post_edits(const RouteContext& context, const Request& request, const std::string& id) {
    const Job job = own_job_at(context.jobs, request, id);
    const Json body = json_body(request, context.limits.request_bytes);
    check_precondition(request, job);
    check_editable(job);
    if (has_ended(job.state)) check_unfinished(context, request.client, job);
    JobEdit edit{read_edits(JsonView(body, "request")), job.frames.last, std::nullopt};
    try_edits(context, job, edit.edits);
    edit.first_frame = job.frames.last + 1;
    for (const Edit& one : edit.edits)
        edit.first_frame =
            std::min(edit.first_frame, first_frame_changed(one, job.frames.first, job.frames_per_second));
    if (edit.first_frame > job.frames.last) edit.reused = 1;  // nobody need take it over
    const auto result = context.jobs.edit(id, job.revision(), std::move(edit));
    const Job now = job_at(context.jobs, id);
    if (result == JobStore::EditResult::stale) throw changed_since(now);
    if (result == JobStore::EditResult::illegal) {
        check_editable(now);
        throw ProblemError({409, "illegal_transition", "the job changed meanwhile", id});
    }
    if (now.state == JobState::queued || now.state == JobState::running) context.worker.take_edits(id);
    return job_reply(now);
}

Reply get_edits(const RouteContext& context, const std::string& id) {
    const Job job = job_at(context.jobs, id);
    Json edits = Json::array();
    for (int revision = 1; revision <= job.revision(); ++revision)
        edits.push_back(to_json(job.edits[static_cast<std::size_t>(revision) - 1], revision));
    return json_reply({{"revision", job.revision()}, {"edits", std::move(edits)}});
}

Reply get_editable(const RouteContext& context, const std::string& id) {
    const Job job = job_at(context.jobs, id);
    const World uploaded = uploaded_world(context, job);
    Json editable = editable_json(edited_world(job, uploaded), uploaded);
    editable["revision"] = job.revision();
    return json_reply(editable);
}

}  // namespace

void add_edit_routes(Router& router, const RouteContext& context) {
    // Both read the job's scene in this process; one at a time, that takes no more than its upload's child
    // did.
    const auto reading = std::make_shared<std::mutex>();
    router.add("POST", "/v1/jobs/{}/edits",
               [context, reading](const Request& request, const PathValues& values) {
                   const std::lock_guard lock(*reading);
                   return post_edits(context, request, values[0]);
               });
    router.add("GET", "/v1/jobs/{}/edits",
               [context](const Request&, const PathValues& values) { return get_edits(context, values[0]); });
    router.add("GET", "/v1/jobs/{}/editable", [context, reading](const Request&, const PathValues& values) {
        const std::lock_guard lock(*reading);
        return get_editable(context, values[0]);
    });
}

}  // namespace afterglow
