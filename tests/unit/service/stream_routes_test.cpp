#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/api/routes.h"
#include "tests/unit/service/fake_solver.h"

// The streams over stores of a size that a test can fill.

namespace afterglow {
namespace {

using testing::HasSubstr;

class StreamRoutes : public testing::Test {
  protected:
    StreamRoutes() { add_stream_routes(router_, {scenes_, blobs_, jobs_, frames_, worker_, {}, usage_}); }
    Reply events(const std::string& id, const std::string& after, const std::string& accept = {}) {
        return router_.handle(
            {"GET", "/v1/jobs/" + id + "/events", {}, {{"last-event-id", after}, {"accept", accept}}, ""});
    }

    ScratchFolder folder_;
    FakeSolver solver_;
    SceneStore scenes_{folder_.path() / "uploads", surveys_here(fake_scene)};
    BlobStore blobs_{folder_.path() / "blobs", 1000};
    JobStore jobs_{{{4, 256}, std::chrono::milliseconds(0), 0}};
    FrameStore frames_{folder_.path() / "jobs"};
    Encoder encoder_{frames_, {}};
    Worker worker_{jobs_, encoder_, solver_.factory(), {}};
    Usage usage_;
    Router router_;
};

TEST_F(StreamRoutes, EventsThatWereDroppedAreGone) {
    const std::string id = jobs_.add({}).id;
    FrameInfo picture;
    picture.revision = 1;
    picture.final = true;
    for (; picture.frame < 10; ++picture.frame) jobs_.note_picture(id, picture);
    const Reply reply = events(id, "1");
    EXPECT_EQ(reply.status, 410);
    EXPECT_EQ(parse_json(reply.body, "reply").at("code"), "gone");
    EXPECT_EQ(events(id, "0").status, 410);
    const Reply later = events(id, std::to_string(jobs_.events(id)->last_id() - 1));
    EXPECT_EQ(later.status, 200);
    EXPECT_EQ(later.content_type, "text/event-stream");
}

TEST_F(StreamRoutes, LinesOfJsonAreSentWhereAskedFor) {
    const std::string id = jobs_.add({}).id;
    const Reply reply = events(id, "0", "application/x-ndjson");
    EXPECT_EQ(reply.content_type, "application/x-ndjson");
    std::string text;
    while (text.find("\"event\"") == std::string::npos) text += reply.stream->next().bytes;
    const auto begin = text.find('{');
    const Json event = parse_json(text.substr(begin, text.find('\n', begin) - begin), "line");
    EXPECT_EQ(event.at("event"), "job");
    EXPECT_EQ(event.at("data").at("id"), id);
}

}  // namespace
}  // namespace afterglow
