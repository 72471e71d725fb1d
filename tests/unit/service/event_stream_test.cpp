#include "service/api/event_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace afterglow {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr EventStreamConfig at_once{std::chrono::milliseconds(0), std::chrono::seconds(3600)};

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

TEST(EventStream, WritesEventsAsTheStandardAsks) {
    EXPECT_EQ(sse_text(7, "job", R"({"a":1})"), "id: 7\nevent: job\ndata: {\"a\":1}\n\n");
}

TEST(EventStream, WritesEventsAsLinesWhereThatIsAskedFor) {
    EXPECT_EQ(ndjson_text(7, "job", R"({"a":1})"), "{\"event\":\"job\",\"id\":7,\"data\":{\"a\":1}}\n");
    for (const char* accept :
         {"application/x-ndjson", "Application/X-NDJSON; q=0.9", "text/html, application/x-ndjson"})
        EXPECT_EQ(&format_accepted(accept), &ndjson_format) << accept;
    for (const char* accept :
         {"", "*/*", "text/event-stream", "text/event-stream, application/x-ndjson", "\xFF"})
        EXPECT_EQ(&format_accepted(accept), &sse_format) << accept;
    auto log = std::make_shared<EventLog>();
    log->append(EventKind::job, "1");
    EventStreamConfig config{std::chrono::milliseconds(0), std::chrono::seconds(0), &ndjson_format};
    EventStream stream(log, 0, "", config);
    EXPECT_EQ(stream.next().bytes, "{\"event\":\"job\",\"id\":1,\"data\":1}\n");
    EXPECT_EQ(stream.next().bytes, "\n");
}

TEST(EventStream, SendsItsOpeningThenWhatIsThereThenEnds) {
    auto log = std::make_shared<EventLog>();
    log->append(EventKind::job, "1");
    log->append(EventKind::image, "2", 0);
    EventStream stream(log, 0, "hello", at_once);
    EXPECT_EQ(stream.next().bytes, "hello");
    EXPECT_THAT(stream.next().bytes, StartsWith("id: 1\nevent: job\ndata: 1\n\nid: 2\nevent: image"));
    EXPECT_EQ(stream.next().bytes, "");
    log->append(EventKind::end, "3");
    const Piece last = stream.next();
    EXPECT_THAT(last.bytes, HasSubstr("event: end"));
    EXPECT_EQ(last.then, Piece::Then::end);
}

TEST(EventStream, BeginsAfterTheGivenEvent) {
    auto log = std::make_shared<EventLog>();
    for (const char* data : {"1", "2", "3"}) log->append(EventKind::job, data);
    EventStream stream(log, 2, "", at_once);
    EXPECT_THAT(stream.next().bytes, StartsWith("id: 3\n"));
}

TEST(EventStream, SaysThatItIsAliveWhenNothingHappens) {
    auto log = std::make_shared<EventLog>();
    EventStream stream(log, 0, "", {std::chrono::milliseconds(0), std::chrono::seconds(0)});
    EXPECT_THAT(stream.next().bytes, StartsWith(":"));
}

TEST(EventStream, EndsWhenItCanNoLongerFollow) {
    auto log = std::make_shared<EventLog>(EventLogConfig{.capacity = 2, .batch = 10});
    EventStream stream(log, 0, "", at_once);
    for (int i = 0; i < 5; ++i) log->append(EventKind::final_image, "", i);
    EXPECT_EQ(stream.next().then, Piece::Then::end);
}

TEST(EventStream, SupersededImagesAreLeftOutFinalOnesNever) {
    std::vector<Event> events;
    const auto add = [&](EventKind kind, int frame) {
        events.push_back({events.size() + 1, kind, frame, ""});
    };
    add(EventKind::image, 0);
    add(EventKind::job, -1);
    add(EventKind::image, 0);
    add(EventKind::final_image, 0);
    add(EventKind::image, 1);
    add(EventKind::image, 1);
    std::vector<std::uint64_t> ids;
    for (const Event& event : without_superseded(events)) ids.push_back(event.id);
    EXPECT_THAT(ids, testing::ElementsAre(2, 4, 6));
}

TEST(EventStream, AReplayIsCompleteButASlowReaderSkips) {
    const EventLogConfig config{.capacity = 1000, .batch = 10};
    auto log = std::make_shared<EventLog>(config);
    const auto append_frames = [&] {
        for (int frame = 0; frame < 4; ++frame) {
            for (int revision = 0; revision < 4; ++revision) log->append(EventKind::image, "early", frame);
            log->append(EventKind::final_image, "final", frame);
        }
    };
    append_frames();
    EventStream stream(log, 0, "", at_once);
    const std::string replay = stream.next().bytes + stream.next().bytes;
    EXPECT_EQ(count(replay, "early"), 16U);
    EXPECT_EQ(count(replay, "final"), 4U);

    EXPECT_EQ(stream.next().bytes, "");  // up to date
    append_frames();
    const std::string late = stream.next().bytes + stream.next().bytes;
    EXPECT_EQ(count(late, "early"), 0U);
    EXPECT_EQ(count(late, "final"), 4U);
}

}  // namespace
}  // namespace afterglow
