#pragma once

#include "service/api/usage.h"
#include "service/base/limits.h"
#include "service/http/router.h"
#include "service/store/database.h"
#include "service/store/frame_store.h"
#include "service/store/job_store.h"
#include "service/store/scene_store.h"
#include "service/work/worker.h"

namespace afterglow {

/// What the routes work on; everything must outlive the router.
struct RouteContext {
    SceneStore& scenes;
    JobStore& jobs;
    FrameStore& frames;
    Worker& worker;
    Limits limits;
    Usage& usage;
};

/// Each adds the routes of http-api.md that its name says.
void add_scene_routes(Router& router, const RouteContext& context);
void add_job_routes(Router& router, const RouteContext& context);
void add_frame_routes(Router& router, const RouteContext& context);
void add_stream_routes(Router& router, const RouteContext& context);
void add_status_routes(Router& router, const RouteContext& context, Database& database);

/// The events of an address's job, or a 404 that names it. A job may be removed at any time.
std::shared_ptr<const EventLog> events_at(const JobStore& jobs, const std::string& id);

/// The job of an address, or a 404 that names it.
Job job_at(const JobStore& jobs, const std::string& id);

/// The same, where the client may change it: its own, or any for an admin; 403 otherwise.
Job own_job_at(const JobStore& jobs, const Request& request, const std::string& id);

/// A request body that must be JSON. Errors: 415 for another content type, 413 past `max_bytes`, 400 for text
/// that is no JSON.
Json json_body(const Request& request, std::size_t max_bytes);

}  // namespace afterglow
