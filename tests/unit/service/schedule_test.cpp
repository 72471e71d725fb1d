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
