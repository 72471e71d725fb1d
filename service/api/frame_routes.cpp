#include <limits>

#include "service/api/routes.h"
#include "service/base/frame_range.h"
#include "service/base/option_values.h"
#include "solver/base/hash.h"

namespace afterglow {

namespace {

PictureType read_type(const std::string& text) {
    if (text.empty() || text == "png") return PictureType::png;
    if (text == "exr") return PictureType::exr;
    throw Error(ErrorKind::invalid_input, "request?type", "expected png or exr");
}

/// The frame of an address, within the job's frames, or a 404.
int read_frame(const Job& job, const std::string& text) {
    const auto outside = [&] {
        return ProblemError({404, "not_found",
                             "the job has frames " + std::to_string(job.frames.first) + " to " +
                                 std::to_string(job.frames.last),
                             text});
    };
    try {
        const int frame = static_cast<int>(whole_number("frame", text, job.frames.first, job.frames.last));
        return frame;
    } catch (const Error&) {
        throw outside();
    }
}

Reply get_frames(const RouteContext& context, const std::string& id) {
    const Job job = job_at(context.jobs, id);
    Json frames = Json::array();
    for (const FrameInfo& info : context.frames.newest(id)) frames.push_back(frame_json(job, info));
    return json_reply({{"frames", std::move(frames)}});
}

/// How near each finished frame came and when: `seconds` counts the time that the frames took so far.
Reply get_convergence(const RouteContext& context, const Request& request, const std::string& id) {
    const Job job = job_at(context.jobs, id);
    const std::string type = request.parameter("type");
    if (!type.empty() && type != "json" && type != "csv")
        throw Error(ErrorKind::invalid_input, "request?type", "expected json or csv");
    const auto shown = [](const std::optional<double>& value) {
        return value ? Json(*value) : Json(nullptr);
    };
    Json rows = Json::array();
    std::string csv = "frame,seconds,residual,error_bound,picture_error\n";
    double seconds = 0;
    for (const FrameInfo& info : context.frames.newest(id)) {
        if (!info.final || job.is_stale(info)) continue;
        seconds += info.seconds;
        const Json row = {{"frame", info.frame},
                          {"seconds", seconds},
                          {"residual", info.residual},
                          {"error_bound", shown(info.error_bound)},
                          {"picture_error", shown(info.picture_error)}};
        std::string line;
        for (const auto& [name, value] : row.items())
            line += (line.empty() ? "" : ",") + (value.is_null() ? std::string() : value.dump());
        csv += line + "\n";
        rows.push_back(row);
    }
    if (type == "csv") return {200, "text/csv; charset=utf-8", std::move(csv), {}, nullptr};
    return json_reply({{"frames", std::move(rows)}});
}

/// The revision asked for, or the newest; a problem where there is none yet or never will be.
int choose_revision(const RouteContext& context, const Job& job, int frame, const std::string& asked) {
    const auto newest = context.frames.newest(job.id, frame);
    if (!newest && job.frames_removed)
        throw ProblemError({410, "gone", "the frames of this job have been removed", std::to_string(frame)});
    if (!newest) {
        if (has_ended(job.state))
            throw ProblemError({404, "not_found", "the job ended before this frame", std::to_string(frame)});
        throw ProblemError({425, "not_yet", "this frame has no picture yet", std::to_string(frame)});
    }
    if (asked.empty()) return newest->revision;
    const auto revision = whole_number("request?rev", asked, 1, std::numeric_limits<int>::max());
    if (revision > newest->revision)
        throw ProblemError({404, "not_found", "there is no such revision yet", "request?rev"});
    return static_cast<int>(revision);
}

Reply get_image(const RouteContext& context, const Request& request, const PathValues& values) {
    const Job job = job_at(context.jobs, values[0]);
    const int frame = read_frame(job, values[1]);
    const PictureType type = read_type(request.parameter("type"));
    const std::string asked = request.parameter("rev");
    const int revision = choose_revision(context, job, frame, asked);
    auto bytes = context.frames.read(job.id, frame, revision, type);
    // Without a revision asked for, the final picture may have come between the two calls and be the newest
    // now.
    if (!bytes && asked.empty())
        bytes = context.frames.read(job.id, frame, choose_revision(context, job, frame, asked), type);
    if (!bytes) throw ProblemError({410, "gone", "this revision is kept no longer", "request?rev"});

    const std::string name = type == PictureType::png ? "png" : "exr";
    // A frame that is begun again, after a pause or a crash, counts its revisions from 1 again.
    Hasher content;
    content.add_bytes(bytes->data(), bytes->size());
    const std::string tag = "\"" + content.result().hex() + "-" + name + "\"";
    const auto shown = context.frames.newest(job.id, frame);
    const bool is_final = shown && shown->final && shown->revision == revision;
    Reply reply;
    reply.headers.emplace_back("ETag", tag);
    reply.headers.emplace_back(
        "Cache-Control", asked.empty() || !is_final ? "no-cache" : "public, max-age=31536000, immutable");
    if (request.header("if-none-match").find(tag) != std::string::npos) {
        reply.status = 304;
        return reply;
    }
    reply.content_type = type == PictureType::png ? "image/png" : "image/x-exr";
    reply.body = *std::move(bytes);
    return reply;
}

}  // namespace

void add_frame_routes(Router& router, const RouteContext& context) {
    router.add("GET", "/v1/jobs/{}/frames", [context](const Request&, const PathValues& values) {
        return get_frames(context, values[0]);
    });
    router.add("GET", "/v1/jobs/{}/convergence", [context](const Request& request, const PathValues& values) {
        return get_convergence(context, request, values[0]);
    });
    router.add("GET", "/v1/jobs/{}/frames/{}/image",
               [context](const Request& request, const PathValues& values) {
                   return get_image(context, request, values);
               });
}

}  // namespace afterglow
