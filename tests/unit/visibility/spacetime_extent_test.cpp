#include "solver/visibility/spacetime_extent.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

Box box_of(const Vec3& low, const Vec3& high) {
    return {low, high};
}

bool holds(const Box& box, const Vec3& p) {
    return glm::all(glm::greaterThanEqual(p, box.low)) && glm::all(glm::lessThanEqual(p, box.high));
}

struct Random {
    std::mt19937 engine;
    std::uniform_real_distribution<float> unit{0, 1};

    Vec3 in(const Box& box) {
        return box.low + Vec3(unit(engine), unit(engine), unit(engine)) * box.extent();
    }
    Box box(const Box& within, float size) {
        const Vec3 low = in(within);
        return {low, low + size * Vec3(unit(engine), unit(engine), unit(engine))};
    }
};

TEST(TimeTree, HoldsEveryTimeOnce) {
    Path path;
    path.keys = {{1, {}}, {9, {Vec3(1), Quat(1, 0, 0, 0)}}};
    const TimeTree times = make_time_tree(std::vector{path}, 0.7);
    EXPECT_EQ(times.slices(), 16U);
    EXPECT_EQ(times.slice(0).begin_s, -never);
    EXPECT_EQ(times.slice(15).end_s, never);
    for (std::size_t k = 0; k < times.slices(); ++k) {
        EXPECT_TRUE(k == 0 || times.slice(k).begin_s == times.slice(k - 1).end_s);
        EXPECT_EQ(times.slice_at(times.slice(k).begin_s), k);
    }
    EXPECT_EQ(make_time_tree(std::vector{Path{}}, 1).slices(), 1U);
    EXPECT_EQ(make_time_tree({}, 1).slices(), 1U);
    EXPECT_EQ(make_time_tree(std::vector{path}, 1e-9, 5).slices(), 32U);
}

TEST(TimeTree, OfAJumpAloneHasTwoSlices) {
    Path path;
    path.keys = {{1, {}}, {1, {Vec3(1), Quat(1, 0, 0, 0)}}};
    const TimeTree times = make_time_tree(std::vector{path}, 0.1);
    EXPECT_THAT(times.borders_s, ::testing::ElementsAre(1.0));
    const SpacetimeExtent extent = swept_extent(box_of(Vec3(0), Vec3(0.1F)), path, times, 0);
    EXPECT_TRUE(holds(extent.at(2), Vec3(0.05F)));
    EXPECT_TRUE(holds(extent.at(3), Vec3(1.05F)));
}

TEST(SweptExtent, HoldsTheBodyAtAllTimes) {
    Random random{std::mt19937(3)};
    const Box around = box_of(Vec3(-2), Vec3(2));
    for (int round = 0; round < 40; ++round) {
        Path path = testing::random_path(random.engine, around, 1 + round % 5,
                                         round % 2 == 0 ? testing::Turning::yes : testing::Turning::no);
        if (round % 4 == 1) path.keys[1].time_s = path.keys[0].time_s;
        const TimeTree times = make_time_tree(std::vector{path}, 0.3);
        const Box local = random.box(around, 1);
        const SpacetimeExtent extent = swept_extent(local, path, times, 1e-5F);
        for (int k = 0; k < 400; ++k) {
            const double time = -1 + 8.0 * random.unit(random.engine);
            const Vec3 point = path.at(time).point(random.in(local));
            for (std::size_t node = times.slices() + times.slice_at(time); node > 0; node /= 2)
                ASSERT_TRUE(holds(extent.at(node), point)) << "time " << time << " node " << node;
        }
    }
}

TEST(MayHide, IsExactForBoxes) {
    // Against lines: what may not hide never does; what may either does or comes within 5 cm of it.
    Random random{std::mt19937(5)};
    const Box around = box_of(Vec3(-1), Vec3(1));
    const auto hides = [&](const Box& blocker, const Box& target, const Box& from, int lines) {
        bool met = false;
        for (int k = 0; k < lines && !met; ++k) {
            const Vec3 a = random.in(from), b = random.in(target);
            met = holds(blocker, a + random.unit(random.engine) * (b - a));
        }
        return met;
    };
    int hidden = 0, free = 0;
    for (int round = 0; round < 1000; ++round) {
        const Box blocker = random.box(around, 0.8F), target = random.box(around, 0.8F),
                  from = random.box(around, 0.3F);
        const bool may = may_hide(blocker, target, from);
        if (!may) {
            ASSERT_FALSE(hides(blocker, target, from, 2000)) << "round " << round;
        } else {
            const Box more{blocker.low - 0.05F, blocker.high + 0.05F};
            ASSERT_TRUE(hides(more, target, from, 200'000)) << "round " << round;
        }
        hidden += may ? 1 : 0;
        free += may ? 0 : 1;
    }
    EXPECT_GT(hidden, 50);
    EXPECT_GT(free, 50);
}

TEST(MayHide, TellsNearFromFarAndSideBySide) {
    const Box eye = box_of(Vec3(-0.1F), Vec3(0.1F));
    const Box near = box_of(Vec3(-1, -1, 3), Vec3(1, 1, 4)), far = box_of(Vec3(-1, -1, 6), Vec3(1, 1, 7));
    EXPECT_TRUE(may_hide(near, far, eye));
    EXPECT_FALSE(may_hide(far, near, eye));
    // Parted by no plane across an axis, only by a slanting one.
    const Box left = box_of(Vec3(-3, -1, 5), Vec3(-0.4F, 1, 6)),
              right = box_of(Vec3(0.4F, -1, 4), Vec3(3, 1, 5));
    EXPECT_FALSE(may_hide(left, right, eye));
    EXPECT_FALSE(may_hide(right, left, eye));
    const Box slanting = box_of(Vec3(2, 0, 2), Vec3(2.2F, 1, 2.2F)),
              behind = box_of(Vec3(0.3F, 0, 4), Vec3(2, 1, 5));
    EXPECT_FALSE(may_hide(slanting, behind, eye));
    EXPECT_TRUE(may_hide(near, near, eye));
    EXPECT_FALSE(may_hide(Box{}, near, eye));
}

TEST(HidingSpans, BeginAndEndWithTheMotion) {
    Path path;
    path.keys = {{0, {Vec3(-8, 0, 3), Quat(1, 0, 0, 0)}}, {16, {Vec3(8, 0, 3), Quat(1, 0, 0, 0)}}};
    const TimeTree times = make_time_tree(std::vector{path}, 0.25);
    const SpacetimeExtent blocker = swept_extent(box_of(Vec3(-0.5F), Vec3(0.5F)), path, times, 0);
    const SpacetimeExtent target = resting_extent(box_of(Vec3(-1, -1, 6), Vec3(1, 1, 7)));
    const SpacetimeExtent eye = resting_extent(box_of(Vec3(0), Vec3(0)));
    const auto spans = hiding_spans(blocker, target, eye, times);
    ASSERT_EQ(spans.size(), 1U);
    // At depth 2.5 … 3.5 the cone is ±3.5/6 wide, and the blocker ±.5.
    EXPECT_NEAR(spans[0].begin_s, 8 - 3.5 / 6 - 0.5, 0.51);
    EXPECT_NEAR(spans[0].end_s, 8 + 3.5 / 6 + 0.5, 0.51);
    EXPECT_LE(spans[0].begin_s, 8 - 3.5 / 6 - 0.5);
    EXPECT_GE(spans[0].end_s, 8 + 3.5 / 6 + 0.5);
    EXPECT_TRUE(hiding_spans(target, blocker, eye, times).empty());
}

}  // namespace
}  // namespace afterglow
