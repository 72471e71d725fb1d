#include "solver/base/context.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"

namespace afterglow {
namespace {

using Chunks = std::vector<std::pair<std::size_t, std::size_t>>;

Chunks chunks_of(const Context& context, std::size_t count, std::size_t chunk) {
    Chunks chunks;
    std::mutex mutex;
    context.for_chunks(count, chunk, [&](std::size_t begin, std::size_t end) {
        const std::scoped_lock lock(mutex);
        chunks.emplace_back(begin, end);
    });
    std::sort(chunks.begin(), chunks.end());
    return chunks;
}

TEST(ForChunks, CoverTheRangeOnceInFullChunks) {
    for (const std::size_t count : {0UL, 1UL, 15UL, 16UL, 17UL, 1000UL}) {
        const Chunks chunks = chunks_of(Context(3), count, 16);
        ASSERT_EQ(chunks.size(), (count + 15) / 16);
        std::size_t expected_begin = 0;
        for (const auto& [begin, end] : chunks) {
            EXPECT_EQ(begin, expected_begin);
            EXPECT_EQ(end, std::min(begin + 16, count));
            expected_begin = end;
        }
        EXPECT_EQ(expected_begin, count);
    }
}

TEST(ForChunks, DoNotDependOnTheNumberOfThreads) {
    const Chunks alone = chunks_of(Context(1), 12345, 100);
    for (const int threads : {2, 3, 8}) EXPECT_EQ(chunks_of(Context(threads), 12345, 100), alone) << threads;
}

/// Sums numbers whose floating-point sum depends on the order, chunk by chunk and then in order.
float ordered_sum(const Context& context) {
    constexpr std::size_t count = 100000;
    constexpr std::size_t chunk = 256;
    std::vector<float> partial((count + chunk - 1) / chunk);
    context.for_chunks(count, chunk, [&](std::size_t begin, std::size_t end) {
        float sum = 0;
        for (std::size_t i = begin; i < end; ++i)
            sum += std::sin(static_cast<float>(i)) / static_cast<float>(i + 1);
        partial[begin / chunk] = sum;
    });
    return std::accumulate(partial.begin(), partial.end(), 0.0F);
}

TEST(ForChunks, ReduceToTheSameBitsForAnyNumberOfThreads) {
    const float alone = ordered_sum(Context(1));
    for (const int threads : {2, 3, 5, 0})
        for (int repeat = 0; repeat < 5; ++repeat) EXPECT_EQ(ordered_sum(Context(threads)), alone) << threads;
}

TEST(ForChunks, ThrowOnTheExceptionOfABody) {
    for (const int threads : {1, 4}) {
        const Context context(threads);
        EXPECT_THROW(context.for_chunks(1000, 1,
                                        [](std::size_t begin, std::size_t) {
                                            if (begin == 500)
                                                throw Error(ErrorKind::io, "chunk 500", "broken");
                                        }),
                     Error);
    }
}

TEST(ForChunks, MayNest) {
    const Context context(3);
    std::atomic<std::size_t> done = 0;
    context.for_chunks(20, 1, [&](std::size_t, std::size_t) {
        context.for_chunks(30, 4, [&](std::size_t begin, std::size_t end) { done += end - begin; });
    });
    EXPECT_EQ(done, 600U);
}

TEST(Cancellation, StopsALoopBeforeItsNextChunk) {
    std::stop_source source;
    const Context context(1, source.get_token());
    int bodies = 0;
    try {
        context.for_chunks(1000, 1, [&](std::size_t, std::size_t) {
            if (++bodies == 10) source.request_stop();
        });
        FAIL() << "was not stopped";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::cancelled);
    }
    EXPECT_EQ(bodies, 10);
}

TEST(Cancellation, StopsAtAReportBeforeTheSinkHears) {
    std::stop_source source;
    int heard = 0;
    const Context context(1, source.get_token(), [&](const Progress&) { ++heard; });
    context.report(0.5, "half");
    source.request_stop();
    EXPECT_THROW(context.report(0.6, "more"), Error);
    EXPECT_THROW(context.part(0, 0.5).check_stop(), Error);
    EXPECT_EQ(heard, 1);
}

TEST(Cancellation, NeverHappensWithoutAToken) {
    EXPECT_NO_THROW(Context(1).check_stop());
    EXPECT_NO_THROW(Context(1).report(1, "silent"));
}

TEST(Progress, PartsMapIntoTheWholeAndStayInside) {
    std::vector<double> fractions;
    std::string doing;
    const Context whole(1, {}, [&](const Progress& p) {
        fractions.push_back(p.fraction);
        doing = p.doing;
        EXPECT_GE(p.remaining.count(), 0);
    });
    whole.report(0, "whole");
    const Context middle = whole.part(0.25, 0.75);
    middle.report(0.5, "middle");
    middle.part(0.5, 1).report(1, "its end");
    middle.report(-3, "too low");
    middle.report(7, "too high");
    EXPECT_EQ(fractions, (std::vector<double>{0, 0.5, 0.75, 0.25, 0.75}));
    EXPECT_EQ(doing, "too high");
}

TEST(ContextThreads, AreAsAskedAndNeverNegative) {
    EXPECT_EQ(Context(1).threads(), 1);
    EXPECT_EQ(Context(3).threads(), 3);
    EXPECT_GE(Context(0).threads(), 1);
    EXPECT_THROW(Context(-1), Error);
}

}  // namespace
}  // namespace afterglow
