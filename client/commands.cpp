#include "client/commands.h"

#include <algorithm>
#include <iomanip>
#include <ostream>

#include "client/fetch.h"
#include "client/job.h"
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

std::string job_path(const std::string& id) {
    return "/v1/jobs/" + percent_encode(id);
}

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
        [&](const CancelCommand& cancel) { return run_cancel(session, cancel); },
    };
    return std::visit(run, session.options.command);
}

ExitCode run_get(const Session& session, const GetCommand& command) {
    HttpConnection connection(session.options.server, session.interrupt);
    const auto job_json = json_reply(connection.get(job_path(command.id)), connection.server());
    const Job job = read_job(job_json, connection.server());
    FrameFetcher fetcher(connection, command.out, command.type);
    Json frames = Json::array();
    for (const FrameImage& image : finished_frames(connection, command.id)) {
        Json files = Json::array();
        for (const auto& file : fetcher.fetch(image)) files.push_back(file.string());
        frames.push_back({{"frame", image.frame}, {"files", files}});
    }
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
    HttpConnection connection(session.options.server, session.interrupt);
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
    HttpConnection connection(session.options.server, session.interrupt);
    const Json body = json_reply(connection.get(job_path(command.id)), connection.server());
    if (session.options.format == OutputFormat::json)
        session.out << to_line(body) << '\n';
    else
        print_job(session.out, read_job(body, connection.server()));
    return ExitCode::ok;
}

ExitCode run_cancel(const Session& session, const CancelCommand& command) {
    HttpConnection connection(session.options.server, session.interrupt);
    const Json body = json_reply(connection.post(job_path(command.id) + "/cancel", "", "application/json"),
                                 connection.server());
    if (session.options.format == OutputFormat::json)
        session.out << to_line(body) << '\n';
    else
        session.out << "job " << one_line(command.id) << " " << read_job(body, connection.server()).state_name
                    << '\n';
    return ExitCode::ok;
}

}  // namespace afterglow::client
