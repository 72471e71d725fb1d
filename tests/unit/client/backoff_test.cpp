#include "client/backoff.h"

#include <gtest/gtest.h>

namespace afterglow::client {
namespace {

using namespace std::chrono_literals;

TEST(Backoff, DoublesUpToTheLongestAndThenGivesUp) {
    Backoff backoff({.first = 100ms, .longest = 500ms, .attempts = 5});
    EXPECT_EQ(backoff.next(), 100ms);
    EXPECT_EQ(backoff.next(), 200ms);
    EXPECT_EQ(backoff.next(), 400ms);
    EXPECT_EQ(backoff.next(), 500ms);
    EXPECT_EQ(backoff.next(), 500ms);
    EXPECT_EQ(backoff.next(), std::nullopt);
    EXPECT_EQ(backoff.failures(), 5);
}

TEST(Backoff, StartsOverAfterSuccess) {
    Backoff backoff({.first = 100ms, .longest = 500ms, .attempts = 2});
    backoff.next();
    backoff.next();
    backoff.succeeded();
    EXPECT_EQ(backoff.next(), 100ms);
}

TEST(Backoff, GivesUpAtOnceWhereNoAttemptIsAllowed) {
    EXPECT_EQ(Backoff({.attempts = 0}).next(), std::nullopt);
}

TEST(Backoff, DoesNotOverflowOverManyAttempts) {
    Backoff backoff({.first = 1ms, .longest = 1h, .attempts = 1000});
    std::chrono::milliseconds previous{0};
    while (const auto wait = backoff.next()) {
        ASSERT_GE(*wait, previous);
        ASSERT_LE(*wait, 1h);
        previous = *wait;
    }
    EXPECT_EQ(previous, 1h);
}

}  // namespace
}  // namespace afterglow::client
