#include "client/follow.h"

#include <ostream>

#include "client/fetch.h"
#include "client/text.h"
#include "client/watch.h"

namespace afterglow::client {

namespace {

/// Follows a job; with a folder, fetches its frames as they finish.
ExitCode follow_to_end(const Session& session, const std::string& id, WatchView& view,
                       const std::optional<std::filesystem::path>& out) {
    const std::string path = job_path(id) + "/events";
    HttpConnection events = connect(session);
    HttpConnection pictures = connect(session);
    FrameFetcher fetcher(pictures, out.value_or(""), PictureType::both);
    WatchLinks links;
    links.open = [&](const HttpHeaders& headers, const StreamSink& sink) {
        return events.stream(path, headers, sink);
    };
    links.sleep = [&](std::chrono::milliseconds wait) {
        session.interrupt.sleep(wait);
        session.interrupt.check();
    };
    if (out) links.on_finished = [&](const FrameImage& image) { fetcher.fetch(image); };
    const auto reporter = make_reporter(session.options.format, {session.out, session.err, session.columns});
    const ExitCode code = watch_job("job " + one_line(id), view, *reporter, links);
    // Frames that finished while the connection was down are still to come.
    if (out)
        for (const FrameImage& image : finished_frames(pictures, id)) fetcher.fetch(image);
    return code;
}

}  // namespace

ExitCode follow_job(const Session& session, const std::string& id, WatchView& view,
                    const std::optional<std::filesystem::path>& out) {
    try {
        return follow_to_end(session, id, view, out);
    } catch (const ClientError& error) {
        if (error.code() != ExitCode::interrupted) throw;
        session.err << "Detached; the job goes on. To come back: afterglow watch " << one_line(id)
                    << session.options.server_hint << std::endl;
        return ExitCode::interrupted;
    }
}

ExitCode run_watch(const Session& session, const WatchCommand& command) {
    WatchView view;
    return follow_job(session, command.id, view, std::nullopt);
}

}  // namespace afterglow::client
