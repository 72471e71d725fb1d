#include <cmath>
#include <ostream>

#include "client/commands.h"
#include "client/file.h"
#include "client/job.h"
#include "client/problem.h"
#include "client/text.h"

namespace afterglow::client {

namespace {

constexpr int most_attempts = 8;  // where others edit the same job

Json read_json(const std::filesystem::path& file) {
    const std::string text = read_input(file);
    try {
        return parse_json(text, file.string());
    } catch (const ClientError&) {
        throw ClientError(ExitCode::bad_input, file.string(), "is no JSON");
    }
}

/// The request's body. Errors: bad_input for a file that is no JSON, or not what it should hold.
std::string body_of(const EditCommand& command) {
    if (!command.file) return to_line({{"edits", command.edits}});
    const Json held = read_json(*command.file);
    if (command.file_holds == EditCommand::FileHolds::request) return to_line(held);
    Json edit = command.edits.at(0);
    if (command.file_holds == EditCommand::FileHolds::geometry) {
        edit["add"]["geometry"] = held;
        return to_line({{"edits", {edit}}});
    }
    if (!held.is_object())
        throw ClientError(
            ExitCode::bad_input, command.file->string(),
            "expected {\"translation\": [[t,x,y,z], ...], \"rotation\": [[t,x,y,z,degrees], ...]}");
    for (const auto& [name, keys] : held.items()) {
        if (name != "translation" && name != "rotation")
            throw ClientError(ExitCode::bad_input, command.file->string(),
                              "expected translation and rotation, found \"" + name + "\"");
        edit["path"][name] = keys;
    }
    return to_line({{"edits", {edit}}});
}

/// Edits the job as it is now; what was done to it between the two requests makes the server refuse.
HttpReply try_once(HttpConnection& connection, const std::string& path, const std::string& body) {
    const HttpReply seen = connection.get(path);
    json_reply(seen, connection.server());
    const std::string tag = seen.header("ETag");
    if (tag.empty())
        throw ClientError(ExitCode::no_server, connection.server(),
                          "is too old: it tells no revisions of jobs");
    return connection.post(path + "/edits", body, "application/json", {{"If-Match", tag}});
}

std::string place_text(const Json& corner) {
    std::string text;
    for (const Json& value : corner) {
        std::string number =
            value.is_number() ? Json(std::round(value.get<double>() * 100) / 100).dump() : "?";
        text += (text.empty() ? "" : ",") + number;
    }
    return text;
}

void print_editable(std::ostream& out, const Json& body) {
    for (const Json& object : find_member(body, "objects"))
        out << "object    " << one_line(find_string(object, "node").value_or("")) << " ("
            << one_line(find_string(object, "kind").value_or("")) << ") from "
            << place_text(find_member(object, "low")) << " to " << place_text(find_member(object, "high"))
            << '\n';
    for (const Json& material : find_member(body, "materials")) {
        out << "material  " << one_line(find_string(material, "material").value_or("")) << " reflects "
            << place_text(find_member(material, "reflectance"));
        if (const auto scale = find_number(material, "emission_scale"))
            out << ", emits " << place_text(find_member(material, "emission")) << " (" << percent(*scale)
                << ")";
        out << '\n';
    }
    for (const Json& lamp : find_member(body, "lamps")) {
        out << "lamp      " << one_line(find_string(lamp, "lamp").value_or("")) << " ("
            << one_line(find_string(lamp, "kind").value_or("")) << ") shines "
            << place_text(find_member(lamp, "intensity"));
        if (const auto scale = find_number(lamp, "intensity_scale")) out << " (" << percent(*scale) << ")";
        out << '\n';
    }
    for (const Json& camera : find_member(body, "cameras"))
        if (camera.is_string()) out << "camera    " << one_line(camera.get<std::string>()) << '\n';
}

}  // namespace

ExitCode run_edit(const Session& session, const EditCommand& command) {
    const std::string body = body_of(command);
    HttpConnection connection = connect(session);
    const std::string path = job_path(command.id);
    HttpReply reply = try_once(connection, path, body);
    constexpr int changed_since = 412;
    for (int attempt = 1;
         attempt < most_attempts && reply.status == changed_since && command.on_conflict == OnConflict::retry;
         ++attempt)
        reply = try_once(connection, path, body);
    const Json job = json_reply(reply, connection.server());
    if (session.options.format == OutputFormat::json) {
        session.out << to_line(job) << '\n';
        return ExitCode::ok;
    }
    session.out << "job " << one_line(command.id) << " is at revision "
                << find_int(job, "revision").value_or(0) << "; " << find_int(job, "stale_frames").value_or(0)
                << " finished frames are computed again\n";
    return ExitCode::ok;
}

ExitCode run_editable(const Session& session, const EditableCommand& command) {
    HttpConnection connection = connect(session);
    const Json body = json_reply(connection.get(job_path(command.id) + "/editable"), connection.server());
    if (session.options.format == OutputFormat::json)
        session.out << to_line(body) << '\n';
    else
        print_editable(session.out, body);
    return ExitCode::ok;
}

}  // namespace afterglow::client
