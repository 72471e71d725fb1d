#include "service/jobs/event_log.h"

#include <map>
#include <random>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace afterglow {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds now{0};

/// Everything after `id`, batch by batch.
std::vector<Event> read_all(const EventLog& log, std::uint64_t id) {
    std::vector<Event> all;
    while (true) {
        const auto batch = log.wait_after(id, now);
        if (batch.events.empty()) return all;
        all.insert(all.end(), batch.events.begin(), batch.events.end());
        id = all.back().id;
    }
}

/// Appends a job's worth of events in a legal order: frames with a few revisions, progress and warnings
/// between.
std::vector<Event> append_random_job(EventLog& log, std::mt19937& random, int frames) {
    std::vector<Event> appended;
    const auto append = [&](EventKind kind, int frame) {
        appended.push_back({appended.size() + 1, kind, frame, std::to_string(appended.size() + 1)});
        log.append(kind, appended.back().data, frame);
    };
    append(EventKind::job, -1);
    for (int frame = 0; frame < frames; ++frame) {
        for (auto i = random() % 5; i > 0; --i) append(EventKind::image, frame);
        for (auto i = random() % 4; i > 0; --i) append(EventKind::progress, -1);
        if (random() % 8 == 0) append(EventKind::warning, -1);
        append(EventKind::final_image, frame);
    }
    append(EventKind::end, -1);
    return appended;
}

bool must_stay(EventKind kind) {
    return kind != EventKind::progress && kind != EventKind::image;
}

TEST(EventLog, ReplayIsComplete) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::mt19937 random(seed);
        EventLog log({.capacity = 1000, .batch = 1 + seed % 7});
        const auto appended = append_random_job(log, random, 20);
        for (std::uint64_t from = 0; from <= appended.size(); from += 5) {
            const auto events = read_all(log, from);
            std::set<std::uint64_t> ids;
            for (std::size_t i = 0; i < events.size(); ++i) {
                EXPECT_GT(events[i].id, i == 0 ? from : events[i - 1].id);
                EXPECT_EQ(events[i].data, std::to_string(events[i].id));
                ids.insert(events[i].id);
            }
            // With room for all, only progress may be missing.
            for (const Event& event : appended)
                if (event.id > from && event.kind != EventKind::progress) {
                    EXPECT_TRUE(ids.contains(event.id));
                }
        }
        EXPECT_EQ(log.wait_after(appended.size(), now).status, EventLog::Status::ended);
    }
}

TEST(EventLog, KeepsTheNewestProgressOnly) {
    EventLog log;
    for (int i = 1; i <= 100; ++i) log.append(EventKind::progress, std::to_string(i));
    const auto events = read_all(log, 0);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].data, "100");
    EXPECT_EQ(events[0].id, 100U);
}

TEST(EventLog, WhenFullOnlySupersededImagesGo) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::mt19937 random(seed);
        EventLog large({.capacity = 10'000, .batch = 256});
        const auto appended = append_random_job(large, random, 30);
        std::size_t kept = 0;
        for (const Event& event : appended) kept += must_stay(event.kind) ? 1U : 0U;

        // Room for what must stay, the images of one unfinished frame, and the newest progress.
        EventLog log({.capacity = kept + 6, .batch = 256});
        std::mt19937 same(seed);
        append_random_job(log, same, 30);
        EXPECT_NE(log.wait_after(0, now).status, EventLog::Status::too_old);
        std::set<std::uint64_t> ids;
        for (const Event& event : read_all(log, 0)) ids.insert(event.id);
        EXPECT_LE(ids.size(), kept + 6);
        for (const Event& event : appended)
            if (must_stay(event.kind)) {
                EXPECT_TRUE(ids.contains(event.id)) << "seed " << seed << " event " << event.id;
            }
    }
}

TEST(EventLog, ARevisionStaysUntilItsFrameIsFinal) {
    EventLog log({.capacity = 4, .batch = 256});
    for (int i = 0; i < 3; ++i) log.append(EventKind::image, "", 0);
    EXPECT_EQ(read_all(log, 0).size(), 3U);
    log.append(EventKind::final_image, "", 0);
    EXPECT_EQ(read_all(log, 0).size(), 4U);
    log.append(EventKind::image, "", 1);
    const auto events = read_all(log, 0);
    ASSERT_EQ(events.size(), 4U);
    EXPECT_EQ(events.front().id, 2U);
}

TEST(EventLog, SaysWhenItCannotReplay) {
    EventLog log({.capacity = 10, .batch = 256});
    for (int i = 1; i <= 15; ++i) log.append(EventKind::final_image, "", i);
    EXPECT_EQ(log.wait_after(0, now).status, EventLog::Status::too_old);
    EXPECT_EQ(log.wait_after(4, now).status, EventLog::Status::too_old);
    EXPECT_EQ(log.wait_after(5, now).events.size(), 10U);
}

TEST(EventLog, NothingFollowsTheEnd) {
    EventLog log;
    EXPECT_FALSE(log.end().has_value());
    log.append(EventKind::end, "done");
    log.append(EventKind::job, "late");
    EXPECT_EQ(read_all(log, 0).size(), 1U);
    EXPECT_EQ(log.last_id(), 1U);
    ASSERT_TRUE(log.end().has_value());
    EXPECT_EQ(log.end()->data, "done");
}

TEST(EventLog, ClosingWakesThoseWhoWait) {
    EventLog log;
    std::thread closer([&] { log.close(); });
    // Far longer than the test may take: only the waking ends it.
    const auto batch = log.wait_after(0, milliseconds(600'000));
    closer.join();
    EXPECT_EQ(batch.status, EventLog::Status::ended);
}

TEST(EventLog, WaitingEndsWithTheTimeOut) {
    const EventLog log;
    const auto batch = log.wait_after(0, milliseconds(1));
    EXPECT_EQ(batch.status, EventLog::Status::open);
    EXPECT_TRUE(batch.events.empty());
}

TEST(EventLog, ManyReadersSeeTheSameOrderWhileItIsWritten) {
    EventLog log({.capacity = 100'000, .batch = 16});
    std::vector<std::vector<Event>> seen(4);
    std::vector<std::thread> readers;
    for (auto& mine : seen)
        readers.emplace_back([&log, &mine] {
            std::uint64_t reached = 0;
            while (true) {
                const auto batch = log.wait_after(reached, milliseconds(1000));
                if (batch.status == EventLog::Status::ended) return;
                mine.insert(mine.end(), batch.events.begin(), batch.events.end());
                if (!mine.empty()) reached = mine.back().id;
            }
        });
    std::mt19937 random(1);
    const auto appended = append_random_job(log, random, 500);
    for (auto& reader : readers) reader.join();
    for (const auto& mine : seen) {
        std::set<std::uint64_t> ids;
        for (std::size_t i = 1; i < mine.size(); ++i) EXPECT_GT(mine[i].id, mine[i - 1].id);
        for (const Event& event : mine) ids.insert(event.id);
        for (const Event& event : appended)
            if (event.kind != EventKind::progress) {
                EXPECT_TRUE(ids.contains(event.id));
            }
    }
}

}  // namespace
}  // namespace afterglow
