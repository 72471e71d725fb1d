#include "client/options.h"

#include <map>
#include <sstream>

#include <CLI/CLI.hpp>

#include "client/http.h"

namespace afterglow::client {

namespace {

/// What CLI11 fills in; `build` turns it into Options.
struct Raw {
    std::string server;
    bool json = false;
    SubmitCommand submit;
    bool watch = false;
    std::string id;
    std::string out;
    PictureType type = PictureType::both;
    std::map<std::string, CLI::App*> commands;
};

/// An option whose text is turned into a value by one of the parsers of options.h.
template <typename Parse, typename Store>
void add_parsed(CLI::App& app, const std::string& name, const std::string& help, Parse parse, Store store) {
    app.add_option_function<std::string>(
           name, [=](const std::string& text) { store(parse(text)); }, help)
        ->type_name("");
}

void add_settings(CLI::App& app, JobSettings& s) {
    app.add_option("--frames", s.frames, "A-B, inclusive, or A; default: the whole animation")->type_name("");
    app.add_option("--fps", s.fps, "Frame n shows time n/fps; default: the scene's own rate")->type_name("");
    add_parsed(app, "--size", "WxH in pixels", parse_size, [&s](std::pair<int, int> size) {
        s.width = size.first;
        s.height = size.second;
    });
    app.add_option("--quality", s.quality, "draft, preview or final")->type_name("");
    app.add_option("--method", s.method, "Named method")->type_name("");
    app.add_option("--visibility", s.visibility, "How changes of visibility are found")->type_name("");
    app.add_option("--solution", s.solution, "How the light is solved")->type_name("");
    app.add_option("--rays", s.rays, "Sight lines of a patch")->type_name("");
    app.add_option("--patch-size", s.patch_size_m, "Target edge of a patch in metres")->type_name("");
    add_parsed(app, "--error",
               "Asked relative error of the pictures, 0.02 or 2%; settles what --quality would", parse_share,
               [&s](double share) { s.error = share; });
    app.add_option("--estimate", s.estimate, "Of each picture's error: none or probes")->type_name("");
    app.add_option("--camera", s.camera, "Name of the camera; default: the first")->type_name("");
    app.add_option("--seed", s.seed, "Of every random choice")->type_name("");
    app.add_option("--exposure", s.exposure_ev, "Stops; default: automatic")->type_name("");
    add_parsed(app, "--background", "Radiance R,G,B of lines that leave the scene", parse_rgb,
               [&s](const std::vector<double>& rgb) { s.background = rgb; });
}

void add_submit(CLI::App& app, Raw& raw) {
    auto& submit = raw.submit;
    app.add_option("SCENE", submit.scene, "A .glb, .gltf, .obj or .json file")->required()->type_name("");
    app.add_option("--paths", submit.paths, "A .json file with paths of motion")->type_name("");
    add_settings(app, submit.settings);
    add_parsed(app, "--unit", "Unit of an .obj file: m, cm, mm, in, ft, or metres", parse_unit,
               [&submit](double metres) { submit.obj_unit_m = metres; });
    app.add_option("--up", submit.obj_up, "Axis of an .obj file that points up")
        ->check(CLI::IsMember({"y", "z"}))
        ->type_name("");
    app.add_flag("--watch", raw.watch, "Stay and show progress");
    app.add_option("--out", raw.out, "Fetch frames into this folder as they finish; implies --watch")
        ->type_name("");
}

void add_get(CLI::App& app, Raw& raw) {
    const std::map<std::string, PictureType> types{
        {"png", PictureType::png}, {"exr", PictureType::exr}, {"both", PictureType::both}};
    app.add_option("ID", raw.id, "The job")->required()->type_name("");
    app.add_option("-o,--out", raw.out, "Folder for frame_NNNN.png and .exr")->required()->type_name("");
    app.add_option("--type", raw.type, "png, exr or both (the default)")
        ->transform(CLI::CheckedTransformer(types))
        ->type_name("");
}

CLI::App& add_command(CLI::App& app, Raw& raw, const std::string& name, const std::string& help) {
    CLI::App* command = app.add_subcommand(name, help);
    command->fallthrough();
    command->add_flag("--json", raw.json, "JSON on standard output");
    raw.commands[name] = command;
    return *command;
}

void define(CLI::App& app, Raw& raw) {
    app.require_subcommand(1);
    app.add_option("--server", raw.server, "URL; default: AFTERGLOW_SERVER, else http://127.0.0.1:8080")
        ->type_name("");
    add_submit(add_command(app, raw, "submit", "Upload a scene and start a job"), raw);
    const auto with_id = [&](const char* name, const char* help) {
        add_command(app, raw, name, help).add_option("ID", raw.id, "The job")->required()->type_name("");
    };
    with_id("watch", "Show a job's progress until it ends");
    add_get(add_command(app, raw, "get", "Fetch finished frames"), raw);
    add_command(app, raw, "ls", "List the jobs, newest first");
    with_id("show", "Show one job");
    with_id("cancel", "Cancel a job");
}

Command command_of(Raw& raw) {
    const auto chosen = [&](const char* name) { return raw.commands.at(name)->parsed(); };
    if (chosen("submit")) {
        if (!raw.out.empty()) raw.submit.out = raw.out;
        if (raw.watch || raw.submit.out) raw.submit.follow = Follow::watch;
        return std::move(raw.submit);
    }
    if (chosen("ls")) return ListCommand{};
    // An empty id would turn the path of one job into that of all jobs.
    if (raw.id.empty()) throw ClientError(ExitCode::bad_input, "ID", "must not be empty");
    if (chosen("watch")) return WatchCommand{raw.id};
    if (chosen("get")) return GetCommand{raw.id, raw.out, raw.type};
    if (chosen("show")) return ShowCommand{raw.id};
    return CancelCommand{raw.id};
}

}  // namespace

Options parse_options(const std::vector<std::string>& arguments, const std::string& environment_server) {
    CLI::App app("Render animations on an Afterglow server.", "afterglow");
    app.footer(exit_code_help());
    Raw raw;
    define(app, raw);
    try {
        // The library takes the arguments from the back.
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::ParseError& error) {
        std::ostringstream out;
        std::ostringstream err;
        if (app.exit(error, out, err) == 0) return {"", "", OutputFormat::text, HelpCommand{out.str()}};
        throw ClientError(ExitCode::bad_input, "", std::string(error.what()) + " (see --help)");
    }
    Options options;
    const std::string fallback = environment_server.empty() ? "http://127.0.0.1:8080" : environment_server;
    options.server = parse_server_url(raw.server.empty() ? fallback : raw.server);
    if (!raw.server.empty()) options.server_hint = " --server " + options.server;
    options.format = raw.json ? OutputFormat::json : OutputFormat::text;
    options.command = command_of(raw);
    return options;
}

}  // namespace afterglow::client
