#include "client/commands.h"

#include <algorithm>
#include <iomanip>
#include <ostream>

#include "client/completion.h"
#include "client/fetch.h"
#include "client/job.h"
#include "client/movie.h"
#include "client/problem.h"
#include "client/text.h"

namespace afterglow::client {

namespace {

template <typename... Handlers>
struct Overloaded : Handlers... {
    using Handlers::operator()...;
};
template <typename... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

std::string frames_text(const Job& job) {
    return std::to_string(job.frames_done) + "/" + std::to_string(job.frame_count());
}

void print_job(std::ostream& out, const Job& job) {
    out << "job       " << one_line(job.id) << "\nstate     " << job.state_name << "\nscene     " << job.scene
        << "\nframes    " << frames_text(job) << "\nprogress  " << percent(job.progress) << "\ncreated   "
        << job.created << '\n';
    if (!has_ended(job.state) && !job.doing.empty()) out << "doing     " << job.doing << '\n';
    if (!has_ended(job.state) && job.remaining_s)
        out << "left      " << spoken(std::chrono::duration<double>(*job.remaining_s)) << '\n';
    if (!job.error.empty()) out << "error     " << job.error << '\n';
    for (const JobWarning& warning : job.warnings) out << "warning   " << warning_line(warning) << '\n';
}

void print_table(std::ostream& out, const std::vector<Job>& jobs) {
    std::size_t id_width = 2;
    for (const Job& job : jobs) id_width = std::max(id_width, job.id.size());
    const auto row = [&](const std::string& id, const std::string& state, const std::string& frames,
                         const std::string& created) {
        out << std::left << std::setw(static_cast<int>(id_width) + 2) << id << std::setw(11) << state
            << std::setw(11) << frames << created << '\n';
    };
    row("ID", "STATE", "FRAMES", "CREATED");
    for (const Job& job : jobs) row(one_line(job.id), job.state_name, frames_text(job), job.created);
}

}  // namespace

HttpConnection connect(const Session& session) {
    HttpConfig config;
    config.token = session.options.token;
    return HttpConnection(session.options.server, session.interrupt, config);
}

std::string job_path(const std::string& id) {
    return "/v1/jobs/" + percent_encode(id);
}

ExitCode run_command(const Session& session) {
    const auto run = Overloaded{
        [&](const HelpCommand& help) {
            session.out << help.text;
            return ExitCode::ok;
        },
        [&](const SubmitCommand& submit) { return run_submit(session, submit); },
        [&](const WatchCommand& watch) { return run_watch(session, watch); },
        [&](const GetCommand& get) { return run_get(session, get); },
        [&](const ListCommand&) { return run_list(session); },
        [&](const ShowCommand& show) { return run_show(session, show); },
        [&](const StepCommand& step) { return run_step(session, step); },
        [&](const EditCommand& edit) { return run_edit(session, edit); },
        [&](const EditableCommand& editable) { return run_editable(session, editable); },
        [&](const PriorityCommand& priority) { return run_priority(session, priority); },
        [&](const RemoveCommand& remove) { return run_remove(session, remove); },
        [&](const DoctorCommand&) { return run_doctor(session); },
        [&](const CompletionCommand&) { return run_completion(session); },
    };
    return std::visit(run, session.options.command);
}

namespace {

/// What a movie of a job is made of. Errors: bad_input while frames are missing.
MovieFrames frames_to_show(const Json& job_json, const Job& job, const GetCommand& command) {
    if (job.frames_done < job.frame_count())
        throw ClientError(ExitCode::bad_input, "--movie",
                          "only " + frames_text(job) + " frames are finished; wait for the job to end");
    constexpr double usual_rate = 24;
    const double rate = find_number(job_json, "frames_per_second").value_or(usual_rate);
    return {command.out, job.first_frame, rate};
}

}  // namespace

ExitCode run_get(const Session& session, const GetCommand& command) {
    HttpConnection connection = connect(session);
    const auto job_json = json_reply(connection.get(job_path(command.id)), connection.server());
    const Job job = read_job(job_json, connection.server());
    FrameFetcher fetcher(connection, command.out, command.type);
    Json frames = Json::array();
    for (const FrameImage& image : finished_frames(connection, command.id)) {
        Json files = Json::array();
        for (const auto& file : fetcher.fetch(image)) files.push_back(file.string());
        frames.push_back({{"frame", image.frame}, {"files", files}});
    }
    if (command.movie) make_movie(frames_to_show(job_json, job, command), *command.movie);
    if (session.options.format == OutputFormat::json) {
        session.out << to_line({{"id", job.id}, {"state", job.state_name}, {"frames", frames}}) << '\n';
        return ExitCode::ok;
    }
    session.out << frames.size() << " of " << job.frame_count() << " frames in " << command.out.string()
                << " (" << fetcher.fetched() << " files fetched, " << fetcher.present()
                << " already there)\n";
    return ExitCode::ok;
}

ExitCode run_list(const Session& session) {
    HttpConnection connection = connect(session);
    const Json body = json_reply(connection.get("/v1/jobs"), connection.server());
    if (session.options.format == OutputFormat::json) {
        session.out << to_line(body) << '\n';
        return ExitCode::ok;
    }
    std::vector<Job> jobs;
    for (const Json& job : find_member(body, "jobs")) jobs.push_back(read_job(job, connection.server()));
    print_table(session.out, jobs);
    return ExitCode::ok;
}

ExitCode run_show(const Session& session, const ShowCommand& command) {
    HttpConnection connection = connect(session);
    const Json body = json_reply(connection.get(job_path(command.id)), connection.server());
    if (session.options.format == OutputFormat::json)
        session.out << to_line(body) << '\n';
    else
        print_job(session.out, read_job(body, connection.server()));
    return ExitCode::ok;
}

ExitCode run_step(const Session& session, const StepCommand& command) {
    HttpConnection connection = connect(session);
    const std::string path = job_path(command.id) + "/" + std::string(name_of(command.step));
    const Json body = json_reply(connection.post(path, "", "application/json"), connection.server());
    if (session.options.format == OutputFormat::json)
        session.out << to_line(body) << '\n';
    else
        session.out << "job " << one_line(command.id) << " " << read_job(body, connection.server()).state_name
                    << '\n';
    return ExitCode::ok;
}

ExitCode run_priority(const Session& session, const PriorityCommand& command) {
    HttpConnection connection = connect(session);
    const Json body =
        json_reply(connection.patch(job_path(command.id), to_line({{"priority", command.priority}}),
                                    "application/merge-patch+json"),
                   connection.server());
    if (session.options.format == OutputFormat::json)
        session.out << to_line(body) << '\n';
    else
        session.out << "job " << one_line(command.id) << " has priority " << command.priority << '\n';
    return ExitCode::ok;
}

ExitCode run_remove(const Session& session, const RemoveCommand& command) {
    HttpConnection connection = connect(session);
    const bool is_trial = command.removal == Removal::tried;
    const HttpReply reply = connection.remove(job_path(command.id) + (is_trial ? "?dry_run=1" : ""));
    const Json body = json_reply(reply, connection.server());
    if (session.options.format == OutputFormat::json) {
        session.out << to_line(body) << '\n';
        return ExitCode::ok;
    }
    session.out << "job " << one_line(command.id) << (is_trial ? " would be removed" : " removed");
    if (const auto bytes = find_number(body, "bytes")) session.out << ": " << spoken_bytes(*bytes);
    session.out << '\n';
    return ExitCode::ok;
}

ExitCode run_completion(const Session& session) {
    session.out << bash_completion(command_syntax());
    return ExitCode::ok;
}

}  // namespace afterglow::client
