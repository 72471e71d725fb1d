#include "client/watch.h"

#include <deque>

#include <gmock/gmock.h>

namespace afterglow::client {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

struct SilentReporter : WatchReporter {
    void on_event(const ServerEvent& event, const WatchView&, const WatchNews&) override {
        events.push_back(event.name + event.id);
    }
    void on_retry(std::chrono::milliseconds) override {}
    std::vector<std::string> events;
};

/// A server that plays one script for each connection: a status and the bytes of the body, or no answer at
/// all.
struct ScriptedServer {
    struct Connection {
        int status = 200;
        std::vector<std::string> pieces;
    };
    static Connection unreachable() { return {0, {}}; }
    static Connection problem(int status) { return {status, {R"({"detail":"no"})"}}; }

    std::deque<Connection> connections;
    std::vector<std::string> resumed_after;  ///< the Last-Event-ID of each connection
    std::vector<std::chrono::milliseconds> waits;
    std::vector<int> finished;
    SilentReporter reporter;
    WatchView view;

    HttpReply open(const HttpHeaders& headers, const StreamSink& sink) {
        resumed_after.push_back(HttpReply{0, headers, ""}.header("Last-Event-ID"));
        if (connections.empty()) throw ClientError(ExitCode::no_server, "s", "the script is over");
        const Connection connection = connections.front();
        connections.pop_front();
        if (connection.status == 0) throw ClientError(ExitCode::no_server, "s", "cannot be reached");
        HttpReply reply{connection.status, {{"Content-Type", "application/problem+json"}}, ""};
        for (const std::string& piece : connection.pieces) {
            if (connection.status != 200)
                reply.body += piece;
            else if (sink(piece) == StreamNext::stop)
                break;
        }
        return reply;
    }

    ExitCode watch(int attempts = 3) {
        WatchLinks links;
        links.open = [this](const HttpHeaders& headers, const StreamSink& sink) {
            return open(headers, sink);
        };
        links.sleep = [this](std::chrono::milliseconds wait) { waits.push_back(wait); };
        links.on_finished = [this](const FrameImage& image) { finished.push_back(image.frame); };
        return watch_job("job j", view, reporter, links,
                         Backoff({.first = 1ms, .longest = 100ms, .attempts = attempts}));
    }

    /// The error that watching ends in.
    ClientError failure(int attempts = 3) {
        try {
            watch(attempts);
        } catch (const ClientError& error) {
            return error;
        }
        ADD_FAILURE() << "did not fail";
        return {ExitCode::ok, "", ""};
    }
};

std::string event(const std::string& name, int id, const std::string& data) {
    return "event: " + name + "\nid: " + std::to_string(id) + "\ndata: " + data + "\n\n";
}
std::string state(int id, const std::string& name) {
    return event("job", id, R"({"id":"j","first_frame":0,"last_frame":2,"state":")" + name + "\"}");
}
std::string final_image(int id, int frame) {
    return event("image", id, R"({"final":true,"revision":3,"frame":)" + std::to_string(frame) + "}");
}
std::string end(int id, const std::string& name) {
    return event("end", id, R"({"state":")" + name + "\"}");
}

TEST(Watch, EndsAsTheJobEnds) {
    ScriptedServer good;
    good.connections = {{200, {state(1, "running"), final_image(2, 0), end(3, "succeeded")}}};
    EXPECT_EQ(good.watch(), ExitCode::ok);
    EXPECT_THAT(good.reporter.events, ElementsAre("job1", "image2", "end3"));
    EXPECT_THAT(good.finished, ElementsAre(0));
    EXPECT_THAT(good.waits, IsEmpty());

    ScriptedServer stopped;
    stopped.connections = {{200, {end(1, "cancelled")}}};
    EXPECT_EQ(stopped.watch(), ExitCode::job_cancelled);
}

TEST(Watch, AFailedJobIsAnErrorWithTheJobsOwnLine) {
    ScriptedServer told;
    told.connections = {
        {200, {event("error", 1, R"({"place":"lamp","detail":"is dark"})"), end(2, "failed")}}};
    const auto error = told.failure();
    EXPECT_EQ(error.code(), ExitCode::job_failed);
    EXPECT_STREQ(error.what(), "lamp: is dark");
    ScriptedServer untold;
    untold.connections = {{200, {end(1, "failed")}}};
    EXPECT_STREQ(untold.failure().what(), "job j: failed");
}

TEST(Watch, ResumesAfterTheLastWholeEvent) {
    ScriptedServer server;
    server.connections = {
        {200, {state(1, "running"), final_image(2, 0), "event: image\nid: 3\ndata: {\"fra"}},
        {200, {final_image(3, 1)}},
        {200, {final_image(4, 2), end(5, "succeeded")}},
    };
    EXPECT_EQ(server.watch(), ExitCode::ok);
    EXPECT_THAT(server.resumed_after, ElementsAre("", "2", "3"));
    EXPECT_THAT(server.finished, ElementsAre(0, 1, 2));
}

TEST(Watch, GivesUpOnlyAfterFailuresInARow) {
    ScriptedServer server;
    server.connections = {
        {200, {state(1, "running")}}, ScriptedServer::unreachable(), ScriptedServer::unreachable(),
        {200, {final_image(2, 0)}},   ScriptedServer::problem(503),  ScriptedServer::unreachable(),
        {200, {end(3, "succeeded")}},
    };
    EXPECT_EQ(server.watch(3), ExitCode::ok);
    EXPECT_THAT(server.waits, ElementsAre(1ms, 2ms, 4ms, 1ms, 2ms, 4ms));
}

TEST(Watch, GivesUpOnAServerThatIsGone) {
    ScriptedServer server;
    server.connections = {{200, {state(1, "running")}}};
    const auto error = server.failure(3);
    EXPECT_EQ(error.code(), ExitCode::no_server);
    EXPECT_EQ(server.resumed_after.size(), 4U);
}

TEST(Watch, GivesUpOnAServerThatAcceptsAndSaysNothing) {
    ScriptedServer server;
    for (int i = 0; i < 10; ++i) server.connections.push_back({200, {": hello\n\n"}});
    EXPECT_EQ(server.failure(3).code(), ExitCode::no_server);
    EXPECT_EQ(server.resumed_after.size(), 4U);
}

TEST(Watch, DoesNotWaitForAServerThatWasNeverThere) {
    ScriptedServer server;
    server.connections = {ScriptedServer::unreachable()};
    EXPECT_EQ(server.failure().code(), ExitCode::no_server);
    EXPECT_THAT(server.waits, IsEmpty());
}

TEST(Watch, AnUnknownJobIsNotFoundAtOnceAlsoAfterARestart) {
    ScriptedServer unknown;
    unknown.connections = {ScriptedServer::problem(404)};
    EXPECT_EQ(unknown.failure().code(), ExitCode::not_found);
    ScriptedServer restarted;
    restarted.connections = {{200, {state(1, "running")}}, ScriptedServer::problem(404)};
    EXPECT_EQ(restarted.failure().code(), ExitCode::not_found);
}

TEST(Watch, StartsOverWithASnapshotWhereTheEventsAreKeptNoLonger) {
    ScriptedServer server;
    server.connections = {
        {200, {state(7, "running"), final_image(8, 0)}},
        ScriptedServer::problem(410),
        {200,
         {event("snapshot", 90,
                R"({"id":"j","state":"running","frames":[{"frame":0,"final":true,"revision":3}]})"),
          end(91, "succeeded")}},
    };
    EXPECT_EQ(server.watch(), ExitCode::ok);
    EXPECT_THAT(server.resumed_after, ElementsAre("", "8", ""));
    EXPECT_THAT(server.finished, ElementsAre(0)) << "told twice, or not at all";
}

TEST(Watch, ASnapshotOfAnEndedJobIsEnough) {
    ScriptedServer server;
    server.connections = {{200, {event("snapshot", 9, R"({"id":"j","state":"succeeded","frames":[]})")}}};
    EXPECT_EQ(server.watch(), ExitCode::ok);
}

TEST(Watch, AnEventThatCannotBeUnderstoodIsSkippedByTheNextAttempt) {
    ScriptedServer server;
    server.connections = {
        {200, {state(1, "running")}},
        {200, {event("image", 2, "{}") + final_image(3, 0)}},
        {200, {final_image(3, 0), end(4, "succeeded")}},
    };
    EXPECT_EQ(server.watch(), ExitCode::ok);
    EXPECT_THAT(server.resumed_after, ElementsAre("", "1", "2"));
    EXPECT_THAT(server.finished, ElementsAre(0));
}

TEST(Watch, CtrlCIsNeverRetried) {
    WatchView view;
    SilentReporter reporter;
    int opened = 0;
    WatchLinks links;
    links.open = [&](const HttpHeaders&, const StreamSink& sink) -> HttpReply {
        ++opened;
        sink(state(1, "running"));
        throw ClientError(ExitCode::interrupted, "", "interrupted");
    };
    links.sleep = [](std::chrono::milliseconds) {};
    try {
        watch_job("job j", view, reporter, links);
        ADD_FAILURE();
    } catch (const ClientError& error) {
        EXPECT_EQ(error.code(), ExitCode::interrupted);
    }
    EXPECT_EQ(opened, 1);
}

}  // namespace
}  // namespace afterglow::client
