#pragma once

#include "service/api/scene_files.h"
#include "service/api/usage.h"
#include "service/base/limits.h"
#include "service/http/router.h"
#include "service/store/blob_store.h"
#include "service/store/database.h"
#include "service/store/frame_store.h"
#include "service/store/job_store.h"
#include "service/store/scene_store.h"
#include "service/work/worker.h"

namespace afterglow {

/// What the routes work on; everything must outlive the router.
struct RouteContext {
    SceneStore& scenes;
    BlobStore& blobs;
    JobStore& jobs;
    FrameStore& frames;
    Worker& worker;
    Limits limits;
    Usage& usage;
    Unpacker unpack = unpack_here;
};

/// Each adds the routes of http-api.md that its name says.
void add_blob_routes(Router& router, const RouteContext& context);
void add_scene_routes(Router& router, const RouteContext& context);
void add_job_routes(Router& router, const RouteContext& context);
void add_edit_routes(Router& router, const RouteContext& context);
void add_frame_routes(Router& router, const RouteContext& context);
void add_stream_routes(Router& router, const RouteContext& context);
void add_status_routes(Router& router, const RouteContext& context, Database& database);

/// The events of an address's job, or a 404 that names it. A job may be removed at any time.
std::shared_ptr<const EventLog> events_at(const JobStore& jobs, const std::string& id);

/// The job of an address, or a 404 that names it.
Job job_at(const JobStore& jobs, const std::string& id);

/// The same, where the client may change it: its own, or any for an admin; 403 otherwise.
Job own_job_at(const JobStore& jobs, const Request& request, const std::string& id);

/// Refuses one more unfinished job of a client past its quota; what it does to another's is not counted.
/// Errors: ProblemError 429.
void check_unfinished(const RouteContext& context, const Client& client, const Job& job);

/// A job with the entity tag that edits refer to: its revision.
Reply job_reply(const Job& job, int status = 200);

/// A request body that must be JSON of that media type. Errors: 415 for another content type, 413 past
/// `max_bytes`, 400 for text that is no JSON.
Json json_body(const Request& request, std::size_t max_bytes,
               const std::string& media_type = "application/json");

}  // namespace afterglow
