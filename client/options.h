#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "client/json.h"

namespace afterglow::client {

/// What goes to standard output: text for people, or JSON for programs.
enum class OutputFormat { text, json };

/// Settings of a job as given on the command line; what is not given is left to the server.
struct JobSettings {
    std::optional<std::string> frames;  ///< "A-B" or "A"
    std::optional<double> fps;          ///< frame n shows time n / fps
    std::optional<int> width;           ///< pixels
    std::optional<int> height;          ///< pixels
    std::optional<std::string> quality, method, visibility, solution, estimate, camera;  ///< names
    std::optional<int> rays;             ///< sight lines of a patch
    std::optional<double> patch_size_m;  ///< target patch edge
    std::optional<double> error;         ///< asked relative error, 0 to 1
    std::optional<std::uint64_t> seed;
    std::optional<double> exposure_ev;              ///< stops
    std::optional<std::vector<double>> background;  ///< radiance of lines that escape: red, green, blue
};
/// The `settings` member of a new job: only what was given.
Json settings_json(const JobSettings& settings);

/// Whether to stay after submitting.
enum class Follow { detach, watch };

struct SubmitCommand {
    std::filesystem::path scene;
    std::optional<std::filesystem::path> paths;
    JobSettings settings;
    std::optional<double> obj_unit_m;   ///< metres in one unit of an .obj file
    std::optional<std::string> obj_up;  ///< "y" or "z"
    Follow follow = Follow::detach;
    std::optional<std::filesystem::path> out;  ///< where finished frames go; implies Follow::watch
};
struct WatchCommand {
    std::string id;
};
/// Which files `get` fetches.
enum class PictureType { png, exr, both };
struct GetCommand {
    std::string id;
    std::filesystem::path out;
    PictureType type = PictureType::both;
    std::optional<std::filesystem::path> movie;  ///< to be made of the frames, which must then all be there
};
struct ListCommand {};
struct ShowCommand {
    std::string id;
};
/// A change of a job's state.
enum class Step { pause, resume, cancel, retry };
std::string_view name_of(Step step);
struct StepCommand {
    std::string id;
    Step step = Step::cancel;
};
struct PriorityCommand {
    std::string id;
    int priority = 0;  ///< −10 to 10; higher goes first
};
/// Whether `rm` removes, or only says what it would.
enum class Removal { done, tried };
struct RemoveCommand {
    std::string id;
    Removal removal = Removal::done;
};
/// Whether an edit is tried again where the job was edited between reading its revision and editing it.
enum class OnConflict { fail, retry };
/// A change of a job that has been submitted.
struct EditCommand {
    std::string id;
    Json edits;                                 ///< as the interface has them
    std::optional<std::filesystem::path> file;  ///< with a part of them, see `file_holds`
    enum class FileHolds {
        request,   ///< all of them, in place of `edits`
        keys,      ///< translation and rotation of the path that is the only edit
        geometry,  ///< of the object that the only edit adds
    } file_holds = FileHolds::request;
    OnConflict on_conflict = OnConflict::fail;
};
/// Shows what of a job can be edited.
struct EditableCommand {
    std::string id;
};
/// Says whether client and server can work together, and what to do where they cannot.
struct DoctorCommand {};
/// Prints a script that completes command lines in bash.
struct CompletionCommand {};
/// --help was asked for.
struct HelpCommand {
    std::string text;
};
using Command = std::variant<HelpCommand, SubmitCommand, WatchCommand, GetCommand, ListCommand, ShowCommand,
                             StepCommand, PriorityCommand, EditCommand, EditableCommand, RemoveCommand,
                             DoctorCommand, CompletionCommand>;

struct Options {
    std::string server;  ///< as from parse_server_url
    /// What must be added to a command line so that it finds the same server: "" or " --server URL".
    std::string server_hint;
    std::string token;  ///< to be shown to the server; empty: none
    OutputFormat format = OutputFormat::text;
    Command command;
};

/// What the environment says; empty where it says nothing.
struct Environment {
    std::string server;  ///< AFTERGLOW_SERVER
    std::string token;   ///< AFTERGLOW_TOKEN
};

/// Reads the command line, and the token's file if it names one. `arguments` without the program's name; they
/// go before the environment. Errors: bad_input naming the option.
Options parse_options(const std::vector<std::string>& arguments, const Environment& environment);

/// A command and the options it takes, for completion.
struct CommandSyntax {
    std::string name;
    std::vector<std::string> options;  ///< with their dashes, those of its kinds included
    std::vector<std::string> kinds;    ///< one of which must follow; empty: none
};
std::vector<CommandSyntax> command_syntax();

/// "640x360" → width and height, each 1 to 16,384. Errors: bad_input.
std::pair<int, int> parse_size(const std::string& text);
/// "0.02" or "2%" → 0.02. Errors: bad_input where it is no number or not between 0 and 1, both excluded.
double parse_share(const std::string& text);
/// "0.2,0.3,0.5" → three finite numbers of 0 or more. Errors: bad_input.
std::vector<double> parse_rgb(const std::string& text);
/// "m", "cm", "mm", "in", "ft", or metres as a number above 0. Errors: bad_input.
double parse_unit(const std::string& text);

}  // namespace afterglow::client
