#include "service/http/http_server.h"

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include "service/api/service.h"
#include "solver/base/error.h"
#include "tests/unit/service/fake_solver.h"
#include "tests/unit/service/peer.h"

// The service through real sockets on the loopback interface.

namespace afterglow {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::size_t body_limit = 100'000;

class HttpServerTest : public testing::Test {
  protected:
    void SetUp() override { port_ = server_.start(); }
    void TearDown() override {
        solver_.open();
        service_.stop();
        server_.stop();
    }

    [[nodiscard]] std::unique_ptr<httplib::Client> client() const {
        auto client = std::make_unique<httplib::Client>("127.0.0.1", port_);
        client->set_read_timeout(60);
        return client;
    }
    std::string submit(const std::string& settings) {
        const auto http = client();
        const auto scene = http->Post("/v1/scenes", "bytes", "model/gltf-binary");
        const std::string id = parse_json(scene->body, "scene").at("id").get<std::string>();
        const auto job = http->Post("/v1/jobs", R"({"scene":")" + id + R"(","settings":)" + settings + "}",
                                    "application/json");
        EXPECT_EQ(job->status, 201) << job->body;
        return parse_json(job->body, "job").at("id").get<std::string>();
    }
    /// Bytes sent as they are, and all that comes back until the server has nothing more to say or `enough`
    /// has come.
    std::string raw(const std::string& bytes, const std::string& enough) const;

    ScratchFolder folder_;
    FakeSolver solver_;
    Service service_{{folder_.path(), 1, 4, {}}, {fake_scene, solver_.factory()}};
    HttpServer server_{service_.router(), {"127.0.0.1", 0, 32, body_limit, AccessLog::off}};
    int port_ = 0;
};

std::string HttpServerTest::raw(const std::string& bytes, const std::string& enough) const {
    const Peer connection(port_);
    EXPECT_TRUE(connection.send(bytes));
    return connection.receive_until(enough);
}

TEST_F(HttpServerTest, TwoServersCannotShareAPort) {
    HttpServer second(service_.router(), {"127.0.0.1", port_, 4, body_limit, AccessLog::off});
    EXPECT_THROW(second.start(), Error);
    EXPECT_EQ(client()->Get("/healthz")->status, 200);
}

TEST_F(HttpServerTest, EveryRefusalIsAProblem) {
    const auto http = client();
    const auto expect = [](const httplib::Result& result, int status) {
        ASSERT_TRUE(result);
        EXPECT_EQ(result->status, status) << result->body;
        EXPECT_EQ(result->get_header_value("Content-Type"), "application/problem+json");
        EXPECT_EQ(parse_json(result->body, "problem").at("status"), status);
    };
    expect(http->Get("/nowhere"), 404);
    expect(http->Get("/v1/jobs/unknown"), 404);
    expect(http->Delete("/v1/jobs"), 405);
    expect(http->Options("/v1/jobs"), 405);
    expect(http->Put("/v1/jobs", "{}", "application/json"), 405);
    expect(http->Post("/v1/jobs", "{", "application/json"), 400);
    expect(http->Post("/v1/jobs", "{}", "application/json"), 422);
    expect(http->Post("/v1/jobs", "{}", "text/plain"), 415);
    expect(http->Post("/v1/scenes", "bad bytes", "model/gltf-binary"), 422);
    expect(http->Post("/v1/scenes", std::string(body_limit + 1, 'x'), "model/gltf-binary"), 413);
    expect(http->Post("/v1/jobs/unknown/cancel"), 404);
    expect(http->Get("/v1/jobs/" + std::string(6000, 'a')), 404);
    expect(http->Post("/v1/jobs/" + std::string(6000, 'a'), "{}", "application/json"), 405);
}

TEST_F(HttpServerTest, TheMethodsThatAreAllowedAreNamed) {
    EXPECT_EQ(client()->Delete("/v1/jobs")->get_header_value("Allow"), "POST, GET, HEAD");
}

TEST_F(HttpServerTest, AFormIsRefusedAndTheConnectionStaysUsable) {
    const auto http = client();
    http->set_keep_alive(true);
    const httplib::MultipartFormDataItems form = {{"file", "content", "a.glb", "model/gltf-binary"}};
    EXPECT_EQ(http->Post("/v1/paths", form)->status, 415);
    EXPECT_EQ(http->Get("/healthz")->status, 200);
}

TEST_F(HttpServerTest, AFormHoldsTheFilesOfAScene) {
    const httplib::MultipartFormDataItems form = {
        {"files", "bytes", "room/a.obj", "model/obj"},
        {"files", std::string("\0\r\n--x", 6), "room/t.png", "image/png"},
        {"room/note.txt", "no file name", "", ""}};
    const auto made = client()->Post("/v1/scenes?name=room", form);
    ASSERT_EQ(made->status, 201) << made->body;
    auto other = form;
    other[1].content += "1";
    EXPECT_EQ(client()->Post("/v1/scenes", form)->status, 200);
    EXPECT_EQ(client()->Post("/v1/scenes", other)->status, 201);
    other[1].filename = "../t.png";
    EXPECT_EQ(client()->Post("/v1/scenes", other)->status, 422);
    other[1].filename.clear();
    other[1].content.resize(body_limit + 1, 'x');
    EXPECT_EQ(client()->Post("/v1/scenes", other)->status, 413);
}

TEST_F(HttpServerTest, AFormThatIsNoneEndsInAReply) {
    const std::string head =
        "POST /v1/scenes HTTP/1.1\r\nHost: x\r\nContent-Type: multipart/form-data; boundary=b\r\n"
        "Transfer-Encoding: chunked\r\n\r\n";
    const auto chunk = [](const std::string& text) {
        std::ostringstream size;
        size << std::hex << text.size();
        return size.str() + "\r\n" + text + "\r\n";
    };
    const std::string part =
        "--b\r\nContent-Disposition: form-data; name=\"f\"; filename=\"a.obj\"\r\n\r\nx\r\n--b";
    EXPECT_THAT(raw(head + chunk(part + "--\r\n") + "0\r\n\r\n", "}"), StartsWith("HTTP/1.1 201"));
    for (const std::string& text : {std::string("nonsense"), part, part + "nonsense", std::string()})
        EXPECT_THAT(raw(head + chunk(text) + "0\r\n\r\n", "}"), StartsWith("HTTP/1.1 4")) << text;
    // What comes after a boundary that is none is held back by the library, but not without an end.
    std::string endless = head + chunk(part + "nonsense");
    for (int i = 0; i < 20; ++i) endless += chunk(std::string(100'000, 'x'));
    EXPECT_THAT(raw(endless, "}"), testing::AnyOf("", StartsWith("HTTP/1.1 4")));
}

TEST_F(HttpServerTest, AChunkedBodyIsLimitedToo) {
    std::string request =
        "POST /v1/scenes HTTP/1.1\r\nHost: x\r\nContent-Type: model/gltf-binary\r\n"
        "Transfer-Encoding: chunked\r\n\r\n";
    const std::string part(10'000, 'x');
    for (int i = 0; i < 15; ++i) request += "2710\r\n" + part + "\r\n";
    EXPECT_THAT(raw(request + "0\r\n\r\n", "}"), StartsWith("HTTP/1.1 413"));
}

TEST_F(HttpServerTest, ACompressedBodyIsRefusedBeforeItIsUnpacked) {
    const auto http = client();
    http->set_compress(true);
    EXPECT_EQ(http->Post("/v1/scenes", std::string(body_limit + 1, 'x'), "text/plain")->status, 415);
}

TEST_F(HttpServerTest, APostWithoutABodyDoesNotWaitForOne) {
    const std::string reply = raw("POST /v1/jobs/unknown/cancel HTTP/1.1\r\nHost: x\r\n\r\n", "}");
    EXPECT_THAT(reply, StartsWith("HTTP/1.1 404"));
}

TEST_F(HttpServerTest, GarbageIsRefused) {
    EXPECT_THAT(raw("nonsense\r\n\r\n", "}"), StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(raw("GET /" + std::string(10'000, 'a') + " HTTP/1.1\r\n\r\n", "}"),
                StartsWith("HTTP/1.1 414"));
    EXPECT_EQ(client()->Get("/healthz")->status, 200);
}

TEST_F(HttpServerTest, ARangeIsIgnored) {
    const auto reply = client()->Get("/healthz", {{"Range", "bytes=1-2"}});
    EXPECT_EQ(reply->status, 200);
    EXPECT_EQ(reply->body, "{\"status\":\"ok\"}\n");
}

TEST_F(HttpServerTest, EventsStreamToTheEndAndReplay) {
    const std::string id = submit(R"({"frames":"0-2"})");
    const auto all = client()->Get("/v1/jobs/" + id + "/events", {{"Last-Event-ID", "0"}});
    ASSERT_TRUE(all);
    EXPECT_THAT(all->get_header_value("Content-Type"), StartsWith("text/event-stream"));
    EXPECT_THAT(all->body, HasSubstr("id: 1\nevent: job\n"));
    EXPECT_THAT(all->body, HasSubstr("\"final\":true"));
    EXPECT_THAT(all->body, HasSubstr("event: end\ndata: {\"state\":\"succeeded\"}"));
    const auto rest = client()->Get("/v1/jobs/" + id + "/events?last_event_id=1");
    EXPECT_EQ(rest->body.find("id: 1\n"), std::string::npos);
    EXPECT_THAT(rest->body, HasSubstr("event: end"));
}

TEST_F(HttpServerTest, APictureComesByItsUrl) {
    const std::string id = submit(R"({"frames":"0"})");
    client()->Get("/v1/jobs/" + id + "/events?last_event_id=0");
    const auto http = client();
    const auto png = http->Get("/v1/jobs/" + id + "/frames/0/image?type=png&rev=4");
    EXPECT_EQ(png->status, 200);
    EXPECT_THAT(png->body, StartsWith("\x89PNG"));
    const auto head = http->Head("/v1/jobs/" + id + "/frames/0/image");
    EXPECT_EQ(head->status, 200);
    EXPECT_EQ(head->get_header_value("Content-Length"), std::to_string(png->body.size()));
    const auto unchanged =
        http->Get("/v1/jobs/" + id + "/frames/0/image", {{"If-None-Match", png->get_header_value("ETag")}});
    EXPECT_EQ(unchanged->status, 304);
    EXPECT_EQ(http->Get("/healthz")->status, 200);
}

TEST_F(HttpServerTest, AnswersWhileManyStreamsAreOpen) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0"})");
    const std::string request = "GET /v1/jobs/" + id + "/events HTTP/1.1\r\nHost: x\r\n\r\n";
    std::vector<std::unique_ptr<Peer>> streams;
    for (int i = 0; i < 16; ++i) {
        streams.push_back(std::make_unique<Peer>(port_));
        ASSERT_TRUE(streams.back()->send(request));
        EXPECT_THAT(streams.back()->receive_until("event: snapshot"), StartsWith("HTTP/1.1 200"));
    }
    EXPECT_EQ(client()->Get("/healthz")->status, 200);
    solver_.open();
    for (const auto& stream : streams)
        EXPECT_THAT(stream->receive_until("event: end"), HasSubstr("event: end"));
}

TEST_F(HttpServerTest, AReaderThatGoesAwayHarmsNobody) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0-5"})");
    for (int i = 0; i < 40; ++i) {  // more than there are connections at a time
        const Peer connection(port_);
        ASSERT_TRUE(connection.send("GET /v1/jobs/" + id + (i % 2 == 0 ? "/events" : "/live") +
                                    " HTTP/1.1\r\nHost: x\r\n\r\n"));
        connection.receive_until("\r\n\r\n");
    }
    solver_.open();
    EXPECT_THAT(client()->Get("/v1/jobs/" + id + "/events?last_event_id=0")->body,
                HasSubstr("{\"state\":\"succeeded\"}"));
}

TEST_F(HttpServerTest, AReaderThatNeverReadsDoesNotHoldTheJobUp) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0-50"})");
    const Peer asleep(port_);
    ASSERT_TRUE(asleep.send("GET /v1/jobs/" + id + "/live HTTP/1.1\r\nHost: x\r\n\r\n"));
    solver_.open();
    EXPECT_THAT(client()->Get("/v1/jobs/" + id + "/events?last_event_id=0")->body,
                HasSubstr("{\"state\":\"succeeded\"}"));
}

TEST_F(HttpServerTest, ARunningJobIsCancelled) {
    const std::string id = submit(R"({"seed":15})");
    const auto cancelled = client()->Post("/v1/jobs/" + id + "/cancel");
    EXPECT_EQ(cancelled->status, 200);
    EXPECT_THAT(client()->Get("/v1/jobs/" + id + "/events?last_event_id=0")->body,
                HasSubstr("{\"state\":\"cancelled\"}"));
}

TEST_F(HttpServerTest, TwoJobsInterleave) {
    solver_.close();
    const std::string first = submit(R"({"frames":"0-9"})");
    const std::string second = submit(R"({"frames":"0-9"})");
    solver_.open();
    for (const auto& id : {first, second})
        EXPECT_THAT(client()->Get("/v1/jobs/" + id + "/events?last_event_id=0")->body,
                    HasSubstr("succeeded"));
    int changes = 0;
    const auto steps = solver_.steps();
    for (std::size_t i = 1; i < steps.size(); ++i) changes += steps[i].first != steps[i - 1].first ? 1 : 0;
    EXPECT_GE(changes, 17);
}

TEST_F(HttpServerTest, OpenStreamsAreToldTheEndAtAStop) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0"})");
    std::vector<std::unique_ptr<Peer>> streams;
    for (int i = 0; i < 8; ++i) {
        streams.push_back(std::make_unique<Peer>(port_));
        ASSERT_TRUE(streams.back()->send("GET /v1/jobs/" + id + "/events HTTP/1.1\r\nHost: x\r\n\r\n"));
        streams.back()->receive_until("event: snapshot");
    }
    solver_.open();
    service_.stop();
    server_.stop();
    EXPECT_FALSE(server_.is_running());
    // The last chunk of a reply that is complete.
    for (const auto& stream : streams)
        EXPECT_THAT(stream->receive_until("\r\n0\r\n\r\n"),
                    AllOf(HasSubstr("event: end"), EndsWith("\r\n0\r\n\r\n")));
}

TEST_F(HttpServerTest, AStopDoesNotWaitForAReaderThatNeverReads) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0"})");
    const Peer asleep(port_);
    ASSERT_TRUE(asleep.send("GET /v1/jobs/" + id + "/live HTTP/1.1\r\nHost: x\r\n\r\n"));
    // Without an end in sight the stream is cut off: the service itself runs on.
    server_.stop();
    EXPECT_FALSE(server_.is_running());
    solver_.open();
}

}  // namespace
}  // namespace afterglow
