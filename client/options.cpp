#include "client/options.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include <CLI/CLI.hpp>

#include "client/edit_options.h"
#include "client/file.h"
#include "client/http.h"

namespace afterglow::client {

namespace {

/// What CLI11 fills in; `build` turns it into Options.
struct Raw {
    std::string server;
    std::string token_file;
    bool json = false;
    SubmitCommand submit;
    bool watch = false;
    std::string id;
    int priority = 0;
    std::string out;
    std::string movie;
    PictureType type = PictureType::both;
    bool is_trial = false;
    EditText edit;
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
    app.add_option("--movie", raw.movie, "Make a movie of them, such as out.mp4 (needs ffmpeg)")
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
    app.add_option("--token-file", raw.token_file, "File with a token; default: AFTERGLOW_TOKEN, else none")
        ->type_name("");
    add_submit(add_command(app, raw, "submit", "Upload a scene and start a job"), raw);
    const auto with_id = [&](const char* name, const char* help) {
        add_command(app, raw, name, help).add_option("ID", raw.id, "The job")->required()->type_name("");
    };
    with_id("watch", "Show a job's progress until it ends");
    add_get(add_command(app, raw, "get", "Fetch finished frames"), raw);
    add_command(app, raw, "ls", "List the jobs, newest first");
    with_id("show", "Show one job");
    with_id("pause", "Let a job rest after the frame in hand");
    with_id("resume", "Let a paused job go on");
    with_id("cancel", "Cancel a job; its finished frames stay");
    with_id("retry", "Let a failed or cancelled job go on from its last finished frame");
    define_edit(add_command(app, raw, "edit", "Change a job that has been submitted"), raw.edit);
    with_id("priority", "Let a job go before others, or after them");
    raw.commands.at("priority")
        ->add_option("PRIORITY", raw.priority, "-10 to 10; higher goes first, jobs begin with 0")
        ->required()
        ->check(CLI::Range(-10, 10))
        ->type_name("");
    with_id("rm", "Remove a job that has ended, with its pictures");
    raw.commands.at("rm")->add_flag("--dry-run", raw.is_trial, "Say what would go, and leave it");
    add_command(app, raw, "doctor", "Check the way to the server, and what else is needed");
    add_command(app, raw, "completion", "Print completions for bash: source <(afterglow completion)");
}

GetCommand get_command(const Raw& raw) {
    GetCommand get{raw.id, raw.out, raw.type, {}};
    if (!raw.movie.empty()) get.movie = raw.movie;
    if (get.movie && get.type == PictureType::exr)
        throw ClientError(ExitCode::bad_input, "--movie", "is made of .png files: --type png or both");
    return get;
}

Command command_of(Raw& raw) {
    const auto chosen = [&](const char* name) { return raw.commands.at(name)->parsed(); };
    if (chosen("submit")) {
        if (!raw.out.empty()) raw.submit.out = raw.out;
        if (raw.watch || raw.submit.out) raw.submit.follow = Follow::watch;
        return std::move(raw.submit);
    }
    if (chosen("priority")) return PriorityCommand{raw.id, raw.priority};
    if (chosen("ls")) return ListCommand{};
    if (chosen("doctor")) return DoctorCommand{};
    if (chosen("completion")) return CompletionCommand{};
    if (chosen("edit")) return edit_command(*raw.commands.at("edit"), raw.edit);
    // An empty id would turn the path of one job into that of all jobs.
    if (raw.id.empty()) throw ClientError(ExitCode::bad_input, "ID", "must not be empty");
    if (chosen("watch")) return WatchCommand{raw.id};
    if (chosen("get")) return get_command(raw);
    if (chosen("show")) return ShowCommand{raw.id};
    if (chosen("rm")) return RemoveCommand{raw.id, raw.is_trial ? Removal::tried : Removal::done};
    for (const Step step : {Step::pause, Step::resume, Step::retry})
        if (chosen(std::string(name_of(step)).c_str())) return StepCommand{raw.id, step};
    return StepCommand{raw.id, Step::cancel};
}

/// The token that a file holds. Errors: bad_input where it holds none.
std::string read_token(const std::string& file) {
    std::string token = read_input(file);
    token.erase(token.find_last_not_of(" \t\r\n") + 1);
    const bool is_one_word =
        std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c < 127; });
    if (token.empty() || !is_one_word)
        throw ClientError(ExitCode::bad_input, "--token-file " + file,
                          "must hold one token and nothing else");
    return token;
}

}  // namespace

std::string_view name_of(Step step) {
    constexpr std::array<std::string_view, 4> names{"pause", "resume", "cancel", "retry"};
    return names.at(static_cast<std::size_t>(step));
}

Options parse_options(const std::vector<std::string>& arguments, const Environment& environment) {
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
        if (app.exit(error, out, err) == 0) return {"", "", "", OutputFormat::text, HelpCommand{out.str()}};
        std::string what = error.what();
        // The library says of a word that is no command only that one is missing.
        if (app.get_subcommands().empty() && !arguments.empty() && !arguments.front().starts_with('-'))
            what = "there is no command \"" + arguments.front() + "\"";
        throw ClientError(ExitCode::bad_input, "", what + " (see --help)");
    }
    Options options;
    const std::string fallback = environment.server.empty() ? "http://127.0.0.1:8080" : environment.server;
    options.server = parse_server_url(raw.server.empty() ? fallback : raw.server);
    if (!raw.server.empty()) options.server_hint = " --server " + options.server;
    options.token = raw.token_file.empty() ? environment.token : read_token(raw.token_file);
    options.format = raw.json ? OutputFormat::json : OutputFormat::text;
    options.command = command_of(raw);
    return options;
}

std::vector<CommandSyntax> command_syntax() {
    CLI::App app;
    Raw raw;
    define(app, raw);
    std::vector<CommandSyntax> syntax;
    for (const CLI::App* command : app.get_subcommands({})) {
        CommandSyntax& one = syntax.emplace_back(CommandSyntax{command->get_name(), {}, {}});
        std::vector<const CLI::App*> sources{command, &app};
        for (const CLI::App* kind : command->get_subcommands({})) {
            one.kinds.push_back(kind->get_name());
            sources.push_back(kind);
        }
        for (const CLI::App* source : sources)
            for (const CLI::Option* option : source->get_options())
                for (const std::string& name : option->get_lnames())
                    if (std::ranges::find(one.options, "--" + name) == one.options.end())
                        one.options.push_back("--" + name);
    }
    return syntax;
}

}  // namespace afterglow::client
