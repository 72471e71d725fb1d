#include "client/edit_options.h"

#include <charconv>
#include <cmath>
#include <utility>

#include <CLI/CLI.hpp>

namespace afterglow::client {

namespace {

CLI::App& add_kind(CLI::App& edit, EditText& text, const char* kind, const char* help) {
    CLI::App* command = edit.add_subcommand(kind, help);
    command->fallthrough();
    command->add_option("ID", text.id, "The job")->required()->type_name("");
    return *command;
}

void add_name(CLI::App& command, EditText& text, const char* what) {
    command.add_option("NAME", text.name, what)->required()->type_name("");
}

void add_file(CLI::App& command, EditText& text, const char* what) {
    command.add_option("FILE", text.file, what)->required()->type_name("");
}

CLI::Option* add_text(CLI::App& command, const char* name, std::string& value, const char* help) {
    return command.add_option(name, value, help)->type_name("");
}

Json move_edit(const EditText& text) {
    Json move{{"node", text.name}};
    if (!text.by.empty()) move["translation"] = parse_vector("--by", text.by);
    if (text.turn_degrees) move["rotation"] = {0, 1, 0, *text.turn_degrees};
    if (move.size() == 1) throw ClientError(ExitCode::bad_input, "edit move", "needs --by or --turn");
    return {{"move", move}};
}

/// The keys are in a file.
Json path_edit(const EditText& text) {
    Json path{{"node", text.name}};
    if (text.from_s) path["from_s"] = *text.from_s;
    return {{"path", path}};
}

/// The geometry is in a file.
Json add_edit(const EditText& text) {
    Json add{{"node", text.name}};
    if (!text.by.empty()) add["translation"] = parse_vector("--at", text.by);
    if (text.turn_degrees) add["rotation"] = {0, 1, 0, *text.turn_degrees};
    return {{"add", add}};
}

Json light_edit(const EditText& text) {
    // Only the server knows what the scene calls so.
    if (text.scale) return {{"light", {{"name", text.name}, {"scale", *text.scale}}}};
    if (!text.emission.empty())
        return {
            {"light", {{"material", text.name}, {"emission", parse_vector("--emission", text.emission)}}}};
    if (!text.intensity.empty())
        return {{"light", {{"lamp", text.name}, {"intensity", parse_vector("--intensity", text.intensity)}}}};
    throw ClientError(ExitCode::bad_input, "edit light", "needs --scale, --emission or --intensity");
}

Json camera_edit(const EditText& text) {
    Json camera = Json::object();
    if (!text.camera.empty()) camera["camera"] = text.camera;
    if (!text.position.empty()) camera["position"] = parse_vector("--position", text.position);
    if (!text.look_at.empty()) camera["look_at"] = parse_vector("--look-at", text.look_at);
    if (camera.empty())
        throw ClientError(ExitCode::bad_input, "edit camera", "needs --camera, or --position and --look-at");
    return {{"camera", camera}};
}

Json edit_of(const std::string& kind, const EditText& text) {
    if (kind == "move") return move_edit(text);
    if (kind == "light") return light_edit(text);
    if (kind == "camera") return camera_edit(text);
    if (kind == "path") return path_edit(text);
    if (kind == "add") return add_edit(text);
    if (kind == "remove") return {{"remove", {{"node", text.name}}}};
    return {{"material",
             {{"material", text.name}, {"reflectance", parse_vector("--reflectance", text.reflectance)}}}};
}

}  // namespace

CLI::App& define_edit(CLI::App& edit, EditText& text) {
    edit.require_subcommand(1);
    edit.add_flag("--retry", text.retries, "Where the job was edited meanwhile, edit what it is now");
    add_kind(edit, text, "show", "Show what of a job can be edited, by name");
    CLI::App& move =
        add_kind(edit, text, "move", "Move an object: furniture, or an actor along all its path");
    add_name(move, text, "The object");
    add_text(move, "--by", text.by, "X,Y,Z in metres");
    move.add_option("--turn", text.turn_degrees, "Degrees about the vertical")->type_name("");
    CLI::App& light = add_kind(edit, text, "light", "Dim or brighten a lamp");
    add_name(light, text, "The material that shines, or the point, spot or directional light");
    CLI::Option* scale =
        light.add_option("--scale", text.scale, "Times what it gives in the scene")->type_name("");
    CLI::Option* emission =
        add_text(light, "--emission", text.emission, "Of a material: R,G,B in W/m²/sr")->excludes(scale);
    add_text(light, "--intensity", text.intensity, "Of a light: R,G,B in W/sr, directional: W/m²")
        ->excludes(scale)
        ->excludes(emission);
    CLI::App& material = add_kind(edit, text, "material", "Change how much a material reflects");
    add_name(material, text, "The material");
    add_text(material, "--reflectance", text.reflectance, "R,G,B, each from 0 to below 1")->required();
    CLI::App& camera = add_kind(edit, text, "camera", "Take pictures from elsewhere");
    add_text(camera, "--camera", text.camera, "One of the scene's cameras");
    add_text(camera, "--position", text.position, "X,Y,Z in metres");
    add_text(camera, "--look-at", text.look_at, "X,Y,Z in metres");
    add_name(add_kind(edit, text, "remove", "Take a piece of furniture away"), text, "The object");
    CLI::App& path = add_kind(edit, text, "path", "Give an actor another way");
    add_name(path, text, "The actor");
    add_file(path, text,
             "A .json file: {\"translation\": [[t,x,y,z], ...], \"rotation\": [[t,x,y,z,degrees], ...]}");
    path.add_option("--from", text.from_s, "Seconds from which on it holds [0]")->type_name("");
    CLI::App& add = add_kind(edit, text, "add", "Add a piece of furniture");
    add_name(add, text, "Its name, which nothing has");
    add_file(add, text,
             "A .json file with its geometry, such as {\"box\": {\"size\": [1,1,1]}, \"material\": NAME}");
    add_text(add, "--at", text.by, "X,Y,Z in metres: where its origin is");
    add.add_option("--turn", text.turn_degrees, "Degrees about the vertical")->type_name("");
    CLI::App& file = add_kind(edit, text, "file", "Any edits, as the HTTP interface has them");
    add_file(file, text, "A .json file: {\"edits\": [...]}");
    return edit;
}

Command edit_command(const CLI::App& edit, const EditText& text) {
    if (text.id.empty()) throw ClientError(ExitCode::bad_input, "ID", "must not be empty");
    const std::string kind = edit.get_subcommands().front()->get_name();
    if (kind == "show") return EditableCommand{text.id};
    EditCommand command;
    command.id = text.id;
    command.on_conflict = text.retries ? OnConflict::retry : OnConflict::fail;
    using Holds = EditCommand::FileHolds;
    if (!text.file.empty()) command.file = text.file;
    command.file_holds = kind == "path" ? Holds::keys : kind == "add" ? Holds::geometry : Holds::request;
    if (kind != "file") command.edits = Json::array({edit_of(kind, text)});
    return command;
}

std::vector<double> parse_vector(const std::string& option, const std::string& text) {
    std::vector<double> values;
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (;;) {
        double value = 0;
        const auto [rest, error] = std::from_chars(at, end, value);
        if (error != std::errc() || !std::isfinite(value)) break;
        values.push_back(value);
        if (rest == end) {
            if (values.size() == 3) return values;
            break;
        }
        if (*rest != ',') break;
        at = rest + 1;
    }
    throw ClientError(ExitCode::bad_input, option, "\"" + text + "\" is not three numbers, such as 0.5,0,-1");
}

}  // namespace afterglow::client
