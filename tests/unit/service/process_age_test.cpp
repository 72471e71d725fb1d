#include "service/commands/process_age.h"

#include <ctime>

#include <gtest/gtest.h>

namespace afterglow {
namespace {

TEST(ProcessAge, GrowsAndCoversTheProcessorTimeOfTheOnlyThread) {
    const auto before = process_age();
    volatile double work = 0;
    while (static_cast<double>(std::clock()) / CLOCKS_PER_SEC < before.count() + 0.05 && work < 1e6)
        work = work + 1;
    const auto after = process_age();
    EXPECT_GE(after, before);
    EXPECT_GT(after.count(), 0);
    // One thread cannot use more processor time than time has passed; a tick of 10 ms is lost on each clock.
    EXPECT_GE(after.count() + 0.02, static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
}

}  // namespace
}  // namespace afterglow
