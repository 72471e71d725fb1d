#include "client/interrupt.h"

#include <condition_variable>
#include <csignal>
#include <unistd.h>

#include <gtest/gtest.h>

#include "client/error.h"

namespace afterglow::client {
namespace {

using namespace std::chrono_literals;

TEST(Interrupt, SigintSetsTheFlagAndRunsTheActions) {
    Interrupt interrupt;
    EXPECT_FALSE(interrupt.requested());
    EXPECT_NO_THROW(interrupt.check());
    std::mutex mutex;
    std::condition_variable changed;
    int first = 0;
    int second = 0;
    const auto count = [&](int& counter) {
        const std::lock_guard lock(mutex);
        ++counter;
        changed.notify_all();
    };
    interrupt.set_action(&first, [&] { count(first); });
    interrupt.set_action(&second, [&] { count(second); });
    ::kill(::getpid(), SIGINT);
    std::unique_lock lock(mutex);
    // Twice each: an action that came too early for what it should stop is repeated.
    ASSERT_TRUE(changed.wait_for(lock, 30s, [&] { return first >= 2 && second >= 2; }));
    lock.unlock();
    interrupt.set_action(&first, {});
    interrupt.set_action(&second, {});
    EXPECT_TRUE(interrupt.requested());
    EXPECT_THROW(interrupt.check(), ClientError);
    interrupt.sleep(10min);  // returns at once, or the test times out
}

TEST(Interrupt, ASecondSigintExitsAtOnce) {
    EXPECT_EXIT(
        {
            Interrupt interrupt;
            ::kill(::getpid(), SIGINT);
            while (!interrupt.requested()) ::usleep(1000);
            ::kill(::getpid(), SIGINT);
            for (;;) ::pause();
        },
        testing::ExitedWithCode(130), "");
}

}  // namespace
}  // namespace afterglow::client
