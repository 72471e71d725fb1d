#include "solver/base/error.h"

#include <gtest/gtest.h>

namespace afterglow {
namespace {

TEST(Error, ReadsAsPlaceAndMessage) {
    const Error e(ErrorKind::too_large, "room.glb#/accessors/0", "has 10 elements");
    EXPECT_STREQ(e.what(), "room.glb#/accessors/0: has 10 elements");
    EXPECT_EQ(e.kind(), ErrorKind::too_large);
    EXPECT_EQ(e.place(), "room.glb#/accessors/0");
    EXPECT_EQ(e.message(), "has 10 elements");
}

TEST(Error, WithoutAPlaceIsItsMessage) {
    EXPECT_STREQ(Error(ErrorKind::cancelled, "", "stopped on request").what(), "stopped on request");
}

}  // namespace
}  // namespace afterglow
