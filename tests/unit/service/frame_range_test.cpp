#include "service/base/frame_range.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"

namespace afterglow {
namespace {

TEST(FrameRange, IsTwoFramesOrOne) {
    EXPECT_EQ(frame_range("--frames", "0-96"), (FrameRange{0, 96}));
    EXPECT_EQ(frame_range("--frames", "12"), (FrameRange{12, 12}));
    EXPECT_EQ(frame_range("--frames", "7-7"), (FrameRange{7, 7}));
    EXPECT_EQ(frame_range("--frames", "9999999"), (FrameRange{9999999, 9999999}));
}

TEST(FrameRange, NamesThePlaceAndTheText) {
    for (const std::string text : {"", "-", "5-", "-5", "1-2-3", "a-b", "3-2", "0-10000000", "0-99999999999",
                                   "1.5", " 1", "+1-2", "1- 2"}) {
        try {
            frame_range("request#/frames", text);
            ADD_FAILURE() << "took \"" << text << "\"";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::invalid_input);
            EXPECT_EQ(e.place(), "request#/frames");
            EXPECT_THAT(e.message(), testing::HasSubstr(text));
        }
    }
}

}  // namespace
}  // namespace afterglow
