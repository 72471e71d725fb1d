#include "service/api/live_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Bench {
    ScratchFolder folder;
    FrameStore frames{folder.path()};
    std::shared_ptr<EventLog> log = std::make_shared<EventLog>(EventLogConfig{.capacity = 100, .batch = 4});
    LiveStream stream{"job", log, frames, std::chrono::milliseconds(0)};

    void show(int frame, int revision, const std::string& png) {
        const bool final = revision == FakeSolver::revisions;
        frames.put("job", {frame, revision, final, 0, {}}, {png, "exr"});
        log->append(final ? EventKind::final_image : EventKind::image, "", frame);
    }
};

TEST(LiveStream, EachPartBringsItsLengthAndTheBoundaryThatEndsIt) {
    Bench bench;
    EXPECT_EQ(bench.stream.next().bytes, "--picture\r\n");
    bench.show(0, 1, "PNG");
    EXPECT_EQ(bench.stream.next().bytes,
              "Content-Type: image/png\r\nContent-Length: 3\r\n\r\nPNG\r\n--picture\r\n");
    EXPECT_EQ(bench.stream.next().bytes, "");
}

TEST(LiveStream, ASlowReaderGetsTheNewestPictureOnly) {
    Bench bench;
    bench.stream.next();
    for (int frame = 0; frame < 10; ++frame)
        for (int revision = 1; revision <= FakeSolver::revisions; ++revision)
            bench.show(frame, revision, "<" + std::to_string(frame) + "." + std::to_string(revision) + ">");
    const std::string part = bench.stream.next().bytes;
    EXPECT_THAT(part, HasSubstr("<9.4>"));
    EXPECT_THAT(part, Not(HasSubstr("<9.3>")));
    EXPECT_EQ(bench.stream.next().bytes, "");
}

TEST(LiveStream, EndsWithTheJobAfterItsLastPicture) {
    Bench bench;
    bench.stream.next();
    bench.show(0, FakeSolver::revisions, "LAST");
    bench.log->append(EventKind::end, "");
    std::string all;
    Piece piece;
    do {
        piece = bench.stream.next();
        all += piece.bytes;
    } while (piece.then == Piece::Then::more);
    EXPECT_THAT(all, HasSubstr("LAST"));
}

TEST(LiveStream, SurvivesALogThatHasForgotten) {
    ScratchFolder folder;
    FrameStore frames(folder.path());
    auto log = std::make_shared<EventLog>(EventLogConfig{.capacity = 3, .batch = 10});
    LiveStream stream("job", log, frames, std::chrono::milliseconds(0));
    stream.next();
    for (int frame = 0; frame < 10; ++frame) {
        frames.put("job", {frame, 1, true, 0, {}}, {"<" + std::to_string(frame) + ">", ""});
        log->append(EventKind::final_image, "", frame);
    }
    const std::string parts = stream.next().bytes + stream.next().bytes;
    EXPECT_THAT(parts, HasSubstr("<9>"));
}

}  // namespace
}  // namespace afterglow
