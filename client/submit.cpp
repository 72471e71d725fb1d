#include <ostream>

#include "client/commands.h"
#include "client/content_hash.h"
#include "client/file.h"
#include "client/follow.h"
#include "client/job.h"
#include "client/problem.h"
#include "client/scene_files.h"
#include "client/text.h"

namespace afterglow::client {

namespace {

std::string scene_query(const SubmitCommand& command) {
    std::string query = "?name=" + percent_encode(command.scene.filename().string());
    if (command.obj_unit_m) query += "&obj_unit_m=" + Json(*command.obj_unit_m).dump();
    if (command.obj_up) query += "&obj_up=" + *command.obj_up;
    return query;
}

/// Sends a body and returns the reply, which has at least an id.
Json upload(HttpConnection& connection, const std::string& path, const std::string& body,
            const std::string& content_type) {
    Json reply =
        json_reply(connection.post(path, body, content_type), connection.server(), NotFound::bad_input);
    need_string(reply, "id", connection.server());
    return reply;
}

/// Uploads a scene with the files it refers to: those that the server does not have, then the list of them.
Json upload_files(HttpConnection& connection, const SubmitCommand& command, const SceneFiles& files) {
    Json list = Json::object();
    for (const auto& [name, content] : files) {
        const std::string hash = sha256(content);
        list[name] = {{"sha256", hash}};
        const std::string path = "/v1/blobs/" + hash;
        if (connection.head(path).status == 200) continue;
        const HttpReply reply = connection.put(path, content, "application/octet-stream");
        json_reply(reply, connection.server(), NotFound::bad_input);
    }
    const Json manifest{{"main", command.scene.filename().string()}, {"files", std::move(list)}};
    return upload(connection, "/v1/scenes" + scene_query(command), to_line(manifest),
                  "application/vnd.afterglow.files+json");
}

void tell_warnings(const Session& session, WatchView& view, const std::vector<JobWarning>& warnings) {
    for (const JobWarning& warning : warnings)
        if (const std::string line = warning_line(warning); view.warned.insert(line).second)
            session.err << "warning: " << line << std::endl;
}

/// Uploads what the command names and makes the job.
Job submit(const Session& session, const SubmitCommand& command, WatchView& view) {
    // All files are read before anything is sent, so that a misspelt name leaves nothing on the server.
    const std::string type = scene_content_type(command.scene);
    const std::string scene_bytes = read_input(command.scene);
    const SceneFiles files = collect_scene_files(command.scene, scene_bytes);
    const std::string paths_bytes = command.paths ? read_input(*command.paths) : "";

    HttpConnection connection = connect(session);
    const Json scene = files.size() > 1
                           ? upload_files(connection, command, files)
                           : upload(connection, "/v1/scenes" + scene_query(command), scene_bytes, type);
    tell_warnings(session, view, read_warnings(find_member(scene, "warnings")));
    Json request{{"scene", scene["id"]}};
    if (command.paths)
        request["paths"] = upload(connection, "/v1/paths", paths_bytes, "application/json")["id"];
    const Json settings = settings_json(command.settings);
    if (!settings.empty()) request["settings"] = settings;
    const Json job = upload(connection, "/v1/jobs", to_line(request), "application/json");
    tell_warnings(session, view, read_warnings(find_member(job, "warnings")));
    return read_job(job, connection.server());
}

void print_submitted(const Session& session, const SubmitCommand& command, const Job& job) {
    if (session.options.format == OutputFormat::json) {
        session.out << to_line({{"id", job.id},
                                {"state", job.state_name},
                                {"scene", job.scene},
                                {"first_frame", job.first_frame},
                                {"last_frame", job.last_frame}})
                    << std::endl;
        return;
    }
    session.out << "job " << one_line(job.id) << ": " << command.scene.filename().string() << ", frames "
                << job.first_frame << "-" << job.last_frame << std::endl;
    if (command.follow == Follow::detach)
        session.out << "To follow it: afterglow watch " << one_line(job.id) << session.options.server_hint
                    << std::endl;
}

}  // namespace

ExitCode run_submit(const Session& session, const SubmitCommand& command) {
    WatchView view;
    const Job job = submit(session, command, view);
    print_submitted(session, command, job);
    if (command.follow == Follow::detach) return ExitCode::ok;
    return follow_job(session, job.id, view, command.out);
}

}  // namespace afterglow::client
