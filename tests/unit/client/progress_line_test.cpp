#include "client/progress_line.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace afterglow::client {
namespace {

WatchView half_way() {
    WatchView view;
    view.job = Job();
    view.job->first_frame = 10;
    view.job->last_frame = 13;
    view.state = JobState::running;
    view.state_name = "running";
    view.current_frame = 11;
    view.progress = 0.5;
    view.doing = "shooting";
    view.remaining_s = 64;
    view.image = FrameImage{11, 3, FrameImage::Stage::preliminary, 0.012, "", ""};
    view.finished = {10};
    return view;
}

TEST(ProgressLine, ShowsFrameRevisionResidualAndRemainingTime) {
    EXPECT_EQ(
        progress_line(half_way(), 120),
        "[###############...............] 50 %  frame 2 of 4  revision 3  residual 1.2 %  1 min 04 s left  "
        "shooting");
}

TEST(ProgressLine, NeverPassesTheWidthOfTheTerminal) {
    WatchView view = half_way();
    view.doing = "größe größe größe größe größe größe größe größe";
    for (int columns = 0; columns < 140; ++columns) {
        const std::string line = progress_line(view, columns);
        ASSERT_LE(line.size(), static_cast<std::size_t>(columns));
        // A cut never leaves the first byte of ö or ß alone at the end.
        ASSERT_FALSE(line.ends_with('\xC3')) << columns;
    }
}

TEST(ProgressLine, StandsAnyProgressThatAServerMaySend) {
    WatchView view = half_way();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double progress : {-1.0, 7.0, std::nan(""), infinity, -infinity}) {
        view.progress = progress;
        EXPECT_EQ(progress_line(view, 120).find(']'), 31U) << progress;
    }
}

TEST(ProgressLine, LeavesOutWhatIsNotKnown) {
    EXPECT_EQ(progress_line(WatchView(), 80), "[....................] 0 %");
    WatchView view = half_way();
    view.image->frame = 10;  // the newest picture belongs to the frame before
    view.remaining_s.reset();
    EXPECT_EQ(progress_line(view, 120), "[###############...............] 50 %  frame 2 of 4  shooting");
}

TEST(ProgressLine, NamesTheStateBeforeAndAfterTheWork) {
    WatchView view = half_way();
    view.state = JobState::succeeded;
    view.state_name = "succeeded";
    view.progress = 1;
    EXPECT_EQ(progress_line(view, 60), "[###############] 100 %  succeeded  frame 2 of 4  revision 3");
}

TEST(PlainLines, TellFinishedFramesAndStates) {
    const WatchView view = half_way();
    EXPECT_EQ(finished_line(view, FrameImage{10, 4, FrameImage::Stage::final, 0.02, "", ""}),
              "frame 10 done (1 of 4): revision 4, residual 2 %");
    EXPECT_EQ(state_line(view), "running, 4 frames, 1 done");
    WatchView ended = half_way();
    ended.state = JobState::cancelled;
    ended.state_name = "cancelled";
    EXPECT_EQ(state_line(ended), "cancelled");
}

}  // namespace
}  // namespace afterglow::client
