#include "service/api/service.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/base/identity.h"
#include "tests/unit/service/fake_solver.h"
#include "tests/unit/service/replies.h"
#include "tests/unit/service/zip_builder.h"

// The routes, through the router, without a network.

namespace afterglow {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Pair;

class ServiceTest : public testing::Test {
  protected:
    Reply get(const std::string& path, std::map<std::string, std::string> query = {},
              std::map<std::string, std::string> headers = {}) const {
        return service_.router().handle({"GET", path, std::move(query), std::move(headers), ""});
    }
    Reply post(const std::string& path, const std::string& type, const std::string& body,
               std::map<std::string, std::string> query = {}) const {
        return service_.router().handle({"POST", path, std::move(query), {{"content-type", type}}, body});
    }
    Reply post_json(const std::string& path, const std::string& body) const {
        return post(path, "application/json; charset=utf-8", body);
    }
    static Json json(const Reply& reply) { return parse_json(reply.body, "reply"); }

    std::string upload() const {
        return json(post("/v1/scenes", "model/gltf-binary", "bytes")).at("id").get<std::string>();
    }
    std::string submit(const std::string& settings = "{}") const {
        const Reply reply =
            post_json("/v1/jobs", R"({"scene":")" + upload() + R"(","settings":)" + settings + "}");
        EXPECT_EQ(reply.status, 201) << reply.body;
        return json(reply).at("id").get<std::string>();
    }
    std::string read_events(const std::string& id) const {
        return read_to_end(get("/v1/jobs/" + id + "/events", {}, {{"last-event-id", "0"}}));
    }
    static void expect_problem(const Reply& reply, int status, const std::string& place) {
        EXPECT_EQ(reply.status, status) << reply.body;
        EXPECT_EQ(reply.content_type, "application/problem+json");
        EXPECT_EQ(json(reply).at("status"), status);
        EXPECT_EQ(json(reply).value("place", ""), place) << reply.body;
    }

    ScratchFolder folder_;
    FakeSolver solver_;
    Service service_{{folder_.path(), 1, 4, {}}, {fake_scene, solver_.factory()}};
};

TEST_F(ServiceTest, IsHealthy) {
    const Reply reply = get("/healthz");
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(json(reply).at("status"), "ok");
}

TEST_F(ServiceTest, UploadsAreToldApartFromKnownOnes) {
    const Reply first = post("/v1/scenes", "model/gltf-binary", "bytes", {{"name", "room.glb"}});
    EXPECT_EQ(first.status, 201);
    EXPECT_EQ(json(first).at("name"), "room.glb");
    EXPECT_EQ(json(first).at("last_frame"), 9);
    EXPECT_EQ(json(first).at("cameras"), Json::array({"eye"}));
    EXPECT_EQ(post("/v1/scenes", "model/gltf-binary", "bytes").status, 200);
}

TEST_F(ServiceTest, UnusableUploadsAreRefusedAtTheirPlace) {
    expect_problem(post("/v1/scenes", "model/gltf-binary", "bad", {{"name", "a.glb"}}), 422,
                   "a.glb#/nodes/0");
    expect_problem(post("/v1/scenes", "text/plain", "bytes"), 415, "Content-Type");
    expect_problem(post("/v1/scenes", "", "bytes"), 415, "Content-Type");
    expect_problem(post("/v1/scenes", "model/obj", "bytes", {{"obj_up", "x"}}), 422, "request?obj_up");
    expect_problem(post("/v1/scenes", "model/obj", "bytes", {{"obj_unit_m", "-1"}}), 422,
                   "request?obj_unit_m");
    expect_problem(post("/v1/scenes", "model/obj", "bytes", {{"unit", "1"}}), 422, "request?unit");
}

TEST_F(ServiceTest, UnusableJobsAreRefusedAtTheirPlace) {
    const std::string scene = upload();
    const auto with = [&](const std::string& rest) { return R"({"scene":")" + scene + "\"" + rest + "}"; };
    expect_problem(post_json("/v1/jobs", "{"), 400, "request");
    expect_problem(post_json("/v1/jobs", ""), 400, "request");
    expect_problem(post_json("/v1/jobs", std::string(100'000, '[')), 400, "request");
    expect_problem(post_json("/v1/jobs", std::string((1U << 20U) + 1, ' ')), 413, "request");
    expect_problem(post("/v1/jobs", "text/plain", "{}"), 415, "Content-Type");
    expect_problem(post_json("/v1/jobs", R"({"scene":"unknown"})"), 422, "request#/scene");
    expect_problem(post_json("/v1/jobs", with(R"(,"paths":"unknown")")), 422, "request#/paths");
    expect_problem(post_json("/v1/jobs", with(R"(,"settings":{"width":0})")), 422, "request#/settings/width");
    expect_problem(post_json("/v1/jobs", with(R"(,"settings":{"camera":"x"})")), 422,
                   "request#/settings/camera");
    expect_problem(post_json("/v1/jobs", with(R"(,"more":1)")), 422, "request#/more");
    EXPECT_EQ(json(get("/v1/jobs")).at("jobs").size(), 0U);
}

TEST_F(ServiceTest, AJobIsMadeRunAndShown) {
    const Reply made = post_json("/v1/jobs", R"({"scene":")" + upload() + R"("})");
    EXPECT_EQ(made.status, 201);
    const std::string id = json(made).at("id").get<std::string>();
    EXPECT_THAT(made.headers, Contains(Pair("Location", "/v1/jobs/" + id)));
    EXPECT_EQ(json(made).at("state"), "queued");
    EXPECT_EQ(json(made).at("last_frame"), 9);
    read_events(id);
    const Json job = json(get("/v1/jobs/" + id));
    EXPECT_EQ(job.at("state"), "succeeded");
    EXPECT_EQ(job.at("frames_done"), 10);
    EXPECT_EQ(job.at("progress"), 1);
    EXPECT_EQ(job.at("settings").at("width"), SequenceConfig{}.width);
    EXPECT_EQ(json(get("/v1/jobs")).at("jobs").at(0).at("id"), id);
    EXPECT_EQ(json(get("/v1/jobs/" + id + "/frames")).at("frames").size(), 10U);
}

TEST_F(ServiceTest, UnknownAddressesAreNotFound) {
    const std::string id = submit(R"({"frames":"2-4"})");
    read_events(id);
    for (const char* rest : {"", "/frames", "/frames/0/image", "/events", "/live"})
        expect_problem(get(std::string("/v1/jobs/unknown") + rest), 404, "unknown");
    EXPECT_EQ(post("/v1/jobs/unknown/cancel", "", "").status, 404);
    for (const char* frame : {"1", "5", "x", "-2", "2.0", "99999999999999999999"})
        expect_problem(get("/v1/jobs/" + id + "/frames/" + frame + "/image"), 404, frame);
}

TEST_F(ServiceTest, PicturesAreImmutableByRevision) {
    const std::string id = submit(R"({"frames":"0"})");
    read_events(id);
    const Json frame = json(get("/v1/jobs/" + id + "/frames")).at("frames").at(0);
    EXPECT_EQ(frame.at("png"), "/v1/jobs/" + id + "/frames/0/image?type=png&rev=4");
    const std::string path = "/v1/jobs/" + id + "/frames/0/image";
    const Reply exact = get(path, {{"type", "png"}, {"rev", "4"}});
    EXPECT_EQ(exact.status, 200);
    EXPECT_EQ(exact.content_type, "image/png");
    EXPECT_THAT(exact.headers, Contains(Pair("Cache-Control", HasSubstr("immutable"))));
    const auto tag = std::find_if(exact.headers.begin(), exact.headers.end(),
                                  [](const auto& header) { return header.first == "ETag"; });
    ASSERT_NE(tag, exact.headers.end());
    EXPECT_EQ(get(path, {{"rev", "4"}}, {{"if-none-match", tag->second}}).status, 304);

    const Reply newest = get(path, {{"type", "exr"}});
    EXPECT_EQ(newest.content_type, "image/x-exr");
    EXPECT_THAT(newest.headers, Contains(Pair("Cache-Control", "no-cache")));
    EXPECT_EQ(get(path, {{"rev", "1"}}).status, 410);
    EXPECT_EQ(get(path, {{"rev", "5"}}).status, 404);
    expect_problem(get(path, {{"rev", "x"}}), 422, "request?rev");
    expect_problem(get(path, {{"type", "gif"}}), 422, "request?type");
}

TEST_F(ServiceTest, AFrameNotYetBegunComesTooEarly) {
    solver_.close();
    const std::string id = submit();
    EXPECT_EQ(get("/v1/jobs/" + id + "/frames/9/image").status, 425);
    post("/v1/jobs/" + id + "/cancel", "", "");
    EXPECT_EQ(get("/v1/jobs/" + id + "/frames/9/image").status, 404);
    solver_.open();
}

TEST_F(ServiceTest, CancellingTwiceIsAConflict) {
    const std::string id = submit(R"({"seed":15})");
    const Reply cancelled = post("/v1/jobs/" + id + "/cancel", "", "");
    EXPECT_EQ(cancelled.status, 200);
    EXPECT_EQ(json(cancelled).at("state"), "cancelled");
    EXPECT_EQ(post("/v1/jobs/" + id + "/cancel", "", "").status, 409);
    EXPECT_THAT(read_events(id), HasSubstr("event: end\ndata: {\"state\":\"cancelled\"}"));
}

TEST_F(ServiceTest, EventsReplayFromAnyPoint) {
    const std::string id = submit(R"({"frames":"0-1"})");
    const std::string all = read_events(id);
    EXPECT_THAT(all, HasSubstr("id: 1\nevent: job\n"));
    EXPECT_THAT(all, HasSubstr("event: end\ndata: {\"state\":\"succeeded\"}\n\n"));
    for (auto at = all.find("id: "); at != std::string::npos; at = all.find("\nid: ", at + 1)) {
        const auto begin = all.find("id: ", at) + 4;
        const std::string last = all.substr(begin, all.find('\n', begin) - begin);
        const std::string rest = read_to_end(get("/v1/jobs/" + id + "/events", {{"last_event_id", last}}));
        const auto next = all.find("\n\n", begin) + 2;
        EXPECT_THAT(rest, testing::EndsWith(all.substr(next)));
    }
}

TEST_F(ServiceTest, WithoutAnIdTheStreamOpensWithASnapshotAndStillEnds) {
    const std::string id = submit(R"({"frames":"0-1"})");
    read_events(id);
    const std::string text = read_to_end(get("/v1/jobs/" + id + "/events"));
    EXPECT_THAT(text, testing::ContainsRegex("^id: [0-9]+\nevent: snapshot\ndata: "));
    EXPECT_THAT(text, HasSubstr("\"frames\":[{\"frame\":0"));
    EXPECT_THAT(text, HasSubstr("event: end\n"));
}

TEST_F(ServiceTest, EventsThatNeverWereAreGone) {
    const std::string id = submit(R"({"frames":"0"})");
    read_events(id);
    expect_problem(get("/v1/jobs/" + id + "/events", {}, {{"last-event-id", "1000"}}), 410, "Last-Event-ID");
    expect_problem(get("/v1/jobs/" + id + "/events", {}, {{"last-event-id", "x"}}), 422, "Last-Event-ID");
}

TEST_F(ServiceTest, TheLiveViewEndsWithTheJob) {
    const std::string id = submit(R"({"frames":"0-3"})");
    const Reply reply = get("/v1/jobs/" + id + "/live");
    EXPECT_THAT(reply.content_type, HasSubstr("multipart/x-mixed-replace"));
    EXPECT_THAT(read_to_end(reply), HasSubstr("\x89PNG"));
}

TEST_F(ServiceTest, PathsAreKept) {
    const Reply made = post_json("/v1/paths", "{}");
    EXPECT_EQ(made.status, 201);
    EXPECT_FALSE(json(made).at("id").get<std::string>().empty());
    expect_problem(post_json("/v1/paths", "nonsense"), 400, "request");
    expect_problem(post_json("/v1/paths", "[]"), 422, "paths");
    expect_problem(post("/v1/paths", "text/xml", "{}"), 415, "Content-Type");
}

TEST_F(ServiceTest, BlobsAreKeptByTheirHash) {
    const std::string name = sha256("content");
    const std::string path = "/v1/blobs/" + name;
    const auto put = [&](const std::string& address, const std::string& body) {
        return service_.router().handle({"PUT", address, {}, {}, body});
    };
    const auto head = [&](const std::string& address) {
        return service_.router().handle({"HEAD", address, {}, {}, ""});
    };
    EXPECT_EQ(head(path).status, 404);
    expect_problem(put(path, "other"), 422, "body");
    EXPECT_EQ(json(put(path, "other")).at("code"), "hash_mismatch");
    expect_problem(put("/v1/blobs/x", "content"), 422, "sha256");
    EXPECT_EQ(put(path, "content").status, 201);
    EXPECT_EQ(head(path).status, 200);
    EXPECT_EQ(put(path, "content").status, 200);
    EXPECT_EQ(json(put(path, "content")).at("bytes"), 7);
    const Reply read = get(path);
    EXPECT_EQ(read.status, 405);
    EXPECT_THAT(read.headers, Contains(Pair("Allow", "PUT, HEAD")));
}

TEST_F(ServiceTest, ScenesOfSeveralFilesAreReadTogether) {
    const std::string manifest = R"({"files": {"a.obj": {"sha256": ")" + sha256("bytes") +
                                 R"("}, "b.mtl": {"sha256": ")" + sha256("more") + R"("}}})";
    expect_problem(post("/v1/scenes", "application/vnd.afterglow.files+json", manifest), 422,
                   "manifest#/files/a.obj/sha256");
    for (const char* content : {"bytes", "more"})
        EXPECT_EQ(service_.router().handle({"PUT", "/v1/blobs/" + sha256(content), {}, {}, content}).status,
                  201);
    const Reply made =
        post("/v1/scenes", "application/vnd.afterglow.files+json", manifest, {{"name", "room"}});
    EXPECT_EQ(made.status, 201) << made.body;
    EXPECT_EQ(json(made).at("name"), "room");
    const std::string zip = zip_of({{"b.mtl", "more"}, {"a.obj", "bytes"}});
    const Reply again = post("/v1/scenes", "application/zip", zip);
    EXPECT_EQ(again.status, 200);
    EXPECT_EQ(json(again).at("id"), json(made).at("id"));
    const std::string id = json(post("/v1/scenes", "application/zip", zip)).at("id").get<std::string>();
    EXPECT_EQ(post_json("/v1/jobs", R"({"scene":")" + id + R"("})").status, 201);
}

TEST_F(ServiceTest, AJobOfHigherPriorityGoesFirst) {
    solver_.close();
    const std::string in_hand = submit(R"({"frames":"0-2"})");
    const std::string low = submit(R"({"frames":"0-2"})");
    const std::string high = submit(R"({"frames":"0-2"})");
    const Reply changed = service_.router().handle({"PATCH",
                                                    "/v1/jobs/" + high,
                                                    {},
                                                    {{"content-type", "application/merge-patch+json"}},
                                                    R"({"priority": 3})"});
    EXPECT_EQ(changed.status, 200);
    EXPECT_EQ(json(changed).at("priority"), 3);
    EXPECT_EQ(json(get("/v1/jobs/" + high)).at("priority"), 3);
    solver_.open();
    for (const std::string& id : {in_hand, low, high}) read_events(id);
    std::vector<std::string> order;
    for (const auto& [job, frame] : solver_.steps()) order.push_back(job);
    // Whatever was in hand before the change, then the three frames of the high one.
    const auto first = std::ranges::find(order, high);
    ASSERT_LE(first - order.begin(), 2);
    EXPECT_EQ(std::count(first, first + 3, high), 3);
}

TEST_F(ServiceTest, StoppingEndsEveryJobAndStream) {
    const std::string hanging = submit(R"({"seed":15})");
    const std::string waiting = submit();
    service_.stop();
    for (const auto& id : {hanging, waiting}) EXPECT_THAT(read_events(id), HasSubstr("event: end"));
}

TEST_F(ServiceTest, WaitingForAJobCountsAsAStream) {
    solver_.close();
    const std::string id = submit(R"({"frames":"0"})");
    Client client;
    client.quota.streams = 1;
    const auto wait = [&](const std::string& seconds) {
        Request request{"GET", "/v1/jobs/" + id, {{"wait", seconds}}, {}, ""};
        request.client = client;
        return service_.router().handle(request);
    };
    Reply first = wait("60");
    EXPECT_EQ(wait("60").status, 429);
    EXPECT_THAT(get("/metrics").body, HasSubstr("afterglow_streams 1\n"));
    EXPECT_EQ(first.content_type, "application/json");
    solver_.open();
    EXPECT_EQ(parse_json(read_to_end(first), "job").at("state"), "succeeded");
    first.stream = nullptr;
    EXPECT_EQ(parse_json(read_to_end(wait("0")), "job").at("id"), id);
}

TEST_F(ServiceTest, AJobThatIsRemovedLeavesNoPicturesBehind) {
    for (int turn = 0; turn < 20; ++turn) {
        const std::string id = submit(R"({"frames":"0-30"})");
        while (get("/v1/jobs/" + id + "/frames/0/image").status != 200) std::this_thread::yield();
        EXPECT_EQ(post_json("/v1/jobs/" + id + "/cancel", "").status, 200);
        EXPECT_EQ(service_.router().handle({"DELETE", "/v1/jobs/" + id, {}, {}, ""}).status, 200);
    }
    // By the end of another job what was being written is.
    read_events(submit());
    const auto folders = std::filesystem::directory_iterator(folder_.path() / "jobs");
    EXPECT_LE(std::distance(begin(folders), end(folders)), 1);
}

TEST_F(ServiceTest, PicturesThatHadToGoAreGone) {
    const ScratchFolder folder;
    ServiceConfig config{folder.path(), 1, 4, {}};
    config.retention.keep_at_most = 1;
    config.retention.interval = std::chrono::milliseconds(1);
    const Service service(config, {fake_scene, solver_.factory()});
    const auto ask = [&](const std::string& method, const std::string& path, const std::string& body = "") {
        return service.router().handle({method, path, {}, {{"content-type", "application/json"}}, body});
    };
    const std::string scene = json(ask("POST", "/v1/scenes", "bytes")).at("id");
    const std::string id = json(ask("POST", "/v1/jobs", R"({"scene":")" + scene + R"("})")).at("id");
    while (json(ask("GET", "/v1/jobs/" + id)).at("frames_removed").is_null()) std::this_thread::yield();
    const Reply image = ask("GET", "/v1/jobs/" + id + "/frames/3/image");
    EXPECT_EQ(image.status, 410);
    EXPECT_EQ(json(image).at("code"), "gone");
    EXPECT_TRUE(json(ask("GET", "/v1/jobs/" + id + "/frames")).at("frames").empty());
}

}  // namespace
}  // namespace afterglow
