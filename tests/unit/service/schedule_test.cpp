#include "service/work/schedule.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace afterglow {
namespace {

TEST(Schedule, NothingToDo) {
    Schedule schedule(4);
    EXPECT_FALSE(schedule.next().has_value());
    schedule.remove("unknown");
    EXPECT_FALSE(schedule.next().has_value());
}

TEST(Schedule, ResidentJobsTakeTurns) {
    Schedule schedule(3);
    for (const char* job : {"a", "b", "c"}) schedule.add(job);
    std::map<std::string, int> turns;
    for (int i = 0; i < 30; ++i) ++turns[*schedule.next()];
    for (const char* job : {"a", "b", "c"}) EXPECT_EQ(turns[job], 10) << job;
}

TEST(Schedule, ANewJobGoesFirst) {
    Schedule schedule(3);
    schedule.add("a");
    schedule.add("b");
    for (int i = 0; i < 5; ++i) schedule.next();
    schedule.add("c");
    EXPECT_EQ(schedule.next(), "c");
}

TEST(Schedule, WaitingJobsAreAdmittedInTheirOrder) {
    Schedule schedule(1);
    for (const char* job : {"a", "b", "c", "d"}) schedule.add(job);
    schedule.remove("c");
    std::vector<std::string> order;
    while (const auto job = schedule.next()) {
        order.push_back(*job);
        EXPECT_EQ(schedule.next(), job);
        schedule.remove(*job);
    }
    EXPECT_EQ(order, (std::vector<std::string>{"a", "b", "d"}));
}

TEST(Schedule, AHigherPriorityGoesFirst) {
    Schedule schedule(3);
    for (const char* job : {"a", "b", "c"}) schedule.add(job);
    schedule.set_priority("b", 1);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(schedule.next(), "b");
    schedule.set_priority("c", 1);
    std::map<std::string, int> turns;
    for (int i = 0; i < 10; ++i) ++turns[*schedule.next()];
    EXPECT_EQ(turns, (std::map<std::string, int>{{"b", 5}, {"c", 5}}));
    schedule.remove("b");
    schedule.remove("c");
    EXPECT_EQ(schedule.next(), "a");
}

TEST(Schedule, AHigherPriorityTakesThePlaceOfALowerOne) {
    Schedule schedule(2);
    for (const char* job : {"a", "b", "c"}) schedule.add(job);
    schedule.set_priority("a", -1);
    for (int i = 0; i < 4; ++i) schedule.next();
    EXPECT_FALSE(schedule.is_resident("a"));
    schedule.set_priority("d", 2);
    schedule.add("d");
    EXPECT_EQ(schedule.next(), "d");
    EXPECT_TRUE(schedule.is_resident("d"));
    EXPECT_NE(schedule.is_resident("b"), schedule.is_resident("c"));
    schedule.remove("d");
    for (const char* job : {"b", "c"}) {
        EXPECT_NE(schedule.next(), "a");
        EXPECT_TRUE(schedule.is_resident(job));
        schedule.next();
    }
    schedule.remove("b");
    schedule.remove("c");
    EXPECT_EQ(schedule.next(), "a");
}

/// Random arrivals, departures and priorities: no turn ever goes to a job while one of higher priority is
/// there, and equals in memory differ by at most one turn while nothing changes.
TEST(Schedule, PrioritiesHoldUnderAnyLoad) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        Schedule schedule(1 + seed % 4);
        std::map<std::string, int> there;
        for (int step = 0; step < 200; ++step) {
            const std::string job(1, static_cast<char>('a' + random() % 8));
            const int priority = static_cast<int>(random() % 3) - 1;
            const auto what = random() % 4;
            if (what == 0 && !there.contains(job)) {
                schedule.set_priority(job, priority);
                schedule.add(job);
                there[job] = priority;
            } else if (what == 1) {
                schedule.remove(job);
                there.erase(job);
            } else if (what == 2 && there.contains(job)) {
                schedule.set_priority(job, priority);
                there[job] = priority;
            }
            const auto turn = schedule.next();
            ASSERT_EQ(turn.has_value(), !there.empty());
            if (!turn) continue;
            ASSERT_TRUE(there.contains(*turn) && schedule.is_resident(*turn));
            for (const auto& [other, its] : there) ASSERT_LE(its, there.at(*turn)) << other;
        }
        std::map<std::string, int> turns;
        for (int i = 0; i < 40; ++i)
            if (const auto turn = schedule.next()) ++turns[*turn];
        int fewest = 40;
        int most = 0;
        for (const auto& [job, count] : turns) {
            fewest = std::min(fewest, count);
            most = std::max(most, count);
        }
        EXPECT_LE(turns.empty() ? 0 : most - fewest, 1) << seed;
    }
}

/// Random arrivals and departures: never more than the allowed number in turn, and between two turns of a job
/// every other resident job has at most one, newly admitted ones aside.
TEST(Schedule, IsFairUnderAnyLoad) {
    for (unsigned seed = 0; seed < 100; ++seed) {
        std::mt19937 random(seed);
        const std::size_t max_resident = 1 + seed % 4;
        Schedule schedule(max_resident);
        std::map<std::string, int> last_turn;
        std::set<std::string> alive;
        std::set<std::string> begun;
        int count = 0;
        for (int turn = 1; turn < 500; ++turn) {
            if (random() % 4 == 0) {
                const std::string job = std::to_string(count++);
                alive.insert(job);
                schedule.add(job);
            }
            const auto job = schedule.next();
            ASSERT_EQ(job.has_value(), !alive.empty());
            if (!job) continue;
            ASSERT_TRUE(alive.contains(*job));
            begun.insert(*job);
            ASSERT_LE(begun.size(), max_resident);
            // Whoever goes twice in a row is alone among those begun.
            if (last_turn[*job] == turn - 1 && turn > 1) {
                ASSERT_TRUE(begun.size() == 1 || last_turn[*job] == 0) << "seed " << seed;
            }
            last_turn[*job] = turn;
            if (random() % 5 == 0) {
                schedule.remove(*job);
                alive.erase(*job);
                begun.erase(*job);
            }
        }
    }
}

}  // namespace
}  // namespace afterglow
