#include "solver/visibility/relative_motion.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

struct Pair {
    Path body, viewer;
    std::vector<SteadyView> views;
};

Pair random_pair(std::mt19937& random, int round) {
    Box box;
    box.add(Vec3(-3));
    box.add(Vec3(3));
    Pair pair;
    pair.body = testing::random_path(random, box, 1 + round % 4,
                                     round % 2 == 0 ? testing::Turning::yes : testing::Turning::no);
    if (round % 3 != 0) pair.viewer = testing::random_path(random, box, 2, testing::Turning::yes);
    // A jump of one, at a knot of the other.
    if (round % 5 == 1)
        pair.body.keys.push_back({pair.body.keys.back().time_s, {Vec3(1, 2, 3), Quat(1, 0, 0, 0)}});
    pair.views = steady_views(pair.body, pair.viewer);
    return pair;
}

TEST(SteadyViews, HoldAllTimesAndTellThePlace) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> time(-1, 6);
    for (int round = 0; round < 30; ++round) {
        const Pair pair = random_pair(random, round);
        EXPECT_EQ(pair.views.front().begin_s, -std::numeric_limits<double>::infinity());
        EXPECT_EQ(pair.views.back().end_s, std::numeric_limits<double>::infinity());
        for (std::size_t k = 1; k < pair.views.size(); ++k)
            EXPECT_EQ(pair.views[k].begin_s, pair.views[k - 1].end_s);
        for (int k = 0; k < 50; ++k) {
            const double t = k < 5 ? k : time(random);
            const SteadyView& view = view_at(pair.views, t);
            ASSERT_TRUE(view.begin_s <= t && t < view.end_s);
            const Pose body = pair.body.at(t);
            const Vec3 offset(0.3F, -0.2F, 0.1F);
            const Vec3 expected =
                glm::conjugate(body.rotation) * (pair.viewer.at(t).translation + offset - body.translation);
            EXPECT_LT(glm::length(view.place(Vec3d(offset), t) - Vec3d(expected)), 1e-5);
        }
    }
}

TEST(SteadyViews, BoundTheSpeed) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> share(0, 1);
    for (int round = 0; round < 30; ++round) {
        for (const SteadyView& view : random_pair(random, round).views) {
            if (!std::isfinite(view.begin_s) || !std::isfinite(view.end_s)) continue;
            const double from = view.begin_s + 0.5 * share(random) * (view.end_s - view.begin_s);
            const double bound = view.greatest_speed(Vec3d(0.5), from), step = 1e-5;
            for (int k = 0; k < 50; ++k) {
                const double t = from + share(random) * (view.end_s - from - step);
                const Vec3d moved = view.place(Vec3d(0.5), t + step) - view.place(Vec3d(0.5), t);
                EXPECT_LE(glm::length(moved) / step, bound * (1 + 1e-6) + 1e-6);
                if (view.body.motion != Motion::turning) {
                    EXPECT_LT(glm::length(moved / step - view.velocity()), 1e-6);
                }
            }
        }
    }
}

}  // namespace
}  // namespace afterglow
