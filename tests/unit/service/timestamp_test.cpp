#include "service/base/timestamp.h"

#include <gtest/gtest.h>

namespace afterglow {
namespace {

TEST(Timestamp, IsUtcWithMilliseconds) {
    using std::chrono::milliseconds;
    EXPECT_EQ(to_rfc3339(Timestamp(milliseconds(0))), "1970-01-01T00:00:00.000Z");
    EXPECT_EQ(to_rfc3339(Timestamp(milliseconds(1709208000007))), "2024-02-29T12:00:00.007Z");
    EXPECT_EQ(to_rfc3339(Timestamp(milliseconds(-1))), "1969-12-31T23:59:59.999Z");
}

}  // namespace
}  // namespace afterglow
