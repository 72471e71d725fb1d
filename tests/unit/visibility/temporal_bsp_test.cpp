#include "solver/visibility/temporal_bsp.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>

#include "tests/support/actors.h"
#include "tests/support/brute_force.h"

namespace afterglow {
namespace {

using testing::Turning;

constexpr double never = std::numeric_limits<double>::infinity();

/// An actor, who looks at it, and the actor's tree for that viewpoint.
struct Scene {
    Body body;
    Path viewer;
    Viewpoint viewpoint;
    BspTree tree;
    std::vector<SteadyView> views;

    void ready() {
        tree = make_bsp_tree(body);
        views = steady_views(body.path, viewer);
    }
    [[nodiscard]] TemporalBsp at(double time_s) const {
        return make_temporal_bsp(tree, views, viewpoint, time_s);
    }
};

Scene random_scene(std::mt19937& random, int round, Turning turning) {
    Box around;
    around.add(Vec3(-2));
    around.add(Vec3(2));
    Scene scene;
    scene.body.path = testing::random_path(random, around, 1 + round % 4, turning);
    switch (round % 4) {
        case 0:
            testing::add_box(scene.body, Vec3(-0.4F), Vec3(0.4F), 0);
            break;
        case 1:
            testing::add_ring(scene.body, Vec3(0), 0.8F, 0.2F, 0);
            break;
        case 2:
            testing::add_tetrahedron(scene.body, Vec3(0), 0.5F, 0);
            break;
        default:
            testing::add_ball(scene.body, Vec3(0), 0.6F, 1, 0);
            break;
    }
    if (round % 3 == 1) scene.viewer = testing::random_path(random, around, 3, Turning::yes);
    std::uniform_real_distribution<double> unit(-2, 2);
    scene.viewpoint.offset_m = Vec3d(unit(random), unit(random), unit(random));
    if (round % 5 >= 3) scene.viewpoint.radius_m = 0.2;
    if (round % 5 == 3) scene.viewpoint.half_extent_m = Vec3d(0.15, 0.01, 0.1);
    scene.ready();
    return scene;
}

/// All faces that a ray of the body's frame meets, in the order of the tree, never come nearer from one run
/// to the next.
void expect_front_to_back(const Scene& scene, const TemporalBsp& temporal, const Vec3d& origin,
                          const Vec3d& direction) {
    double farthest = 0, of_run = 0;
    for (const OrderedFace& next : temporal.order) {
        if (next.begins_run) farthest = of_run;
        const BspTree::Face& face = scene.tree.faces[next.face];
        const auto& v = scene.body.triangles[face.triangle].vertices;
        const Vec3d a(scene.body.positions[v[0]]), b(scene.body.positions[v[1]]),
            c(scene.body.positions[v[2]]);
        const Vec3d normal = glm::cross(b - a, c - a);
        const double towards = glm::dot(normal, direction);
        if (towards == 0) continue;
        const double distance = glm::dot(normal, a - origin) / towards;
        const Vec3d hit = origin + distance * direction;
        const auto inside = [&](const Vec3d& p, const Vec3d& q) {
            return glm::dot(glm::cross(q - p, hit - p), normal) >= 0;
        };
        if (distance <= 0 || !inside(a, b) || !inside(b, c) || !inside(c, a)) continue;
        if (!scene.tree.holds(face, hit)) continue;
        ASSERT_GE(distance, farthest - 1e-6);
        of_run = std::max(of_run, distance);
    }
}

void expect_same(const TemporalBsp& a, const TemporalBsp& b) {
    ASSERT_EQ(a.order.size(), b.order.size());
    for (std::size_t k = 0; k < a.order.size(); ++k) {
        ASSERT_EQ(a.order[k].face, b.order[k].face);
        ASSERT_EQ(a.order[k].begins_run, b.order[k].begins_run);
    }
}

TEST(TemporalBsp, OrdersFrontToBackForAllTimes) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> share(0, 1);
    for (int round = 0; round < 60; ++round) {
        const Scene scene = random_scene(random, round, round % 2 == 0 ? Turning::yes : Turning::no);
        TemporalBsp temporal = scene.at(-0.5);
        for (int step = 0; step < 60; ++step) {
            const double time = -0.5 + 0.1 * step;
            update(temporal, scene.tree, scene.views, scene.viewpoint, time);
            ASSERT_GE(temporal.next_change_s(), temporal.since_s);
            for (int k = 0; k < 10; ++k) {
                Vec3d off(normal(random), normal(random), normal(random));
                off *= 0.999 * scene.viewpoint.radius_m * share(random) / glm::length(off);
                // In world axes as the box is, then as the body sees it.
                off = glm::clamp(off, -scene.viewpoint.half_extent_m, scene.viewpoint.half_extent_m);
                const Vec3d origin = view_at(scene.views, time).place(scene.viewpoint.offset_m + off, time);
                const Vec3d towards(0.5 * normal(random), 0.5 * normal(random), 0.5 * normal(random));
                expect_front_to_back(scene, temporal, origin, glm::normalize(towards - origin));
            }
        }
    }
}

TEST(TemporalBsp, UpdatedIsTheSameAsMadeAnewAndVisitsOnlyWhatIsDue) {
    std::mt19937 random(12);
    std::uint64_t visited = 0, all = 0, changes = 0, still = 0;
    for (int round = 0; round < 40; ++round) {
        const Scene scene = random_scene(random, round, round % 4 < 2 ? Turning::yes : Turning::no);
        TemporalBsp temporal = scene.at(0);
        for (int step = 1; step <= 100; ++step) {
            // Now and then back in time.
            const double time = step % 33 == 0 ? 0.02 * step : 0.04 * step;
            const TreeWork work = update(temporal, scene.tree, scene.views, scene.viewpoint, time);
            expect_same(temporal, scene.at(time));
            visited += work.nodes_visited;
            changes += work.sides_changed;
            still += work.nodes_visited == 0 ? 1U : 0U;
            all += scene.tree.nodes.size();
        }
    }
    EXPECT_GT(changes, 100U);
    EXPECT_LT(visited, all / 4);
    EXPECT_GT(still, 400U);
}

TEST(TemporalBsp, PredictsTheRootsOfTranslation) {
    std::mt19937 random(13);
    int compared = 0;
    for (int round = 0; round < 60; ++round) {
        const Scene scene = random_scene(random, round, Turning::no);

        for (const double time : {-0.3, 0.0, 0.4, 1.0, 1.7, 2.0, 3.5}) {
            const TemporalBsp temporal = scene.at(time);
            const double end = view_at(scene.views, time).end_s;
            for (Index n = 0; n < scene.tree.nodes.size(); ++n) {
                // These bodies never turn: their axes are the world's.
                const double radius = std::min(
                    scene.viewpoint.radius_m,
                    glm::dot(glm::abs(scene.tree.nodes[n].plane.normal), scene.viewpoint.half_extent_m));
                const auto side = [&](double t) {
                    const double above = scene.tree.nodes[n].plane.above(
                        view_at(scene.views, time).place(scene.viewpoint.offset_m, t));
                    return above >= radius    ? PlaneSide::front
                           : above <= -radius ? PlaneSide::back
                                              : PlaneSide::across;
                };
                if (temporal.nodes[n].change_s == 0 && temporal.nodes[n].earliest_s == 0) continue;
                // The first of many small steps in which the side differs, then bisection.
                double low = time, high = never;
                const double until = std::min(end, time + 20);
                for (int k = 1; k <= 4000 && high == never; ++k) {
                    const double t = time + (until - time) * k / 4000.0 * (1 - 1e-12);
                    if (side(t) != side(time))
                        high = t;
                    else
                        low = t;
                }
                if (high == never) {
                    EXPECT_GE(temporal.nodes[n].change_s, until - 1e-6);
                    continue;
                }
                for (int k = 0; k < 60; ++k) {
                    const double middle = 0.5 * (low + high);
                    (side(middle) == side(time) ? low : high) = middle;
                }
                EXPECT_NEAR(temporal.nodes[n].change_s, low, 1e-6);
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 500);
}

TEST(TemporalBsp, NeverPredictsTooLateWhileTurning) {
    std::mt19937 random(14);
    for (int round = 0; round < 30; ++round) {
        const Scene scene = random_scene(random, 4 * (round % 6), Turning::yes);
        for (const double time : {0.1, 0.6, 1.3}) {
            const TemporalBsp temporal = scene.at(time);
            const TemporalBsp just_before = scene.at(time + 0.999 * (temporal.next_change_s() - time));
            expect_same(just_before, temporal);
            ASSERT_GT(temporal.next_change_s(), time);
        }
    }
}

/// A box that comes along x at 1 m/s, seen from a point.
Scene coming_box(const Vec3d& from, double radius = 0) {
    Scene scene;
    testing::add_box(scene.body, Vec3(-1), Vec3(1), 0);
    scene.body.path.keys = {{0, {Vec3(-10, 0, 0), Quat(1, 0, 0, 0)}},
                            {10, {Vec3(0), Quat(1, 0, 0, 0)}},
                            {20, {Vec3(0, 10, 0), Quat(1, 0, 0, 0)}}};
    scene.viewpoint = {from, radius};
    scene.ready();
    return scene;
}

TEST(TemporalBsp, StoresSignsAndTimesOfAPassingBox) {
    const Scene scene = coming_box(Vec3d(-4, 0, 3));
    const TemporalBsp temporal = scene.at(0);
    // The box's front reaches the viewpoint's plane after 5 s, its back after 7 s.
    EXPECT_DOUBLE_EQ(temporal.next_change_s(), 5);
    TemporalBsp later = temporal;
    EXPECT_EQ(update(later, scene.tree, scene.views, scene.viewpoint, 4.999).nodes_visited, 0U);
    EXPECT_EQ(update(later, scene.tree, scene.views, scene.viewpoint, 5.001).sides_changed, 1U);
    EXPECT_DOUBLE_EQ(later.next_change_s(), 7);
    // After that nothing until the knot, where all velocities change.
    update(later, scene.tree, scene.views, scene.viewpoint, 7.5);
    EXPECT_DOUBLE_EQ(later.next_change_s(), 10);
    update(later, scene.tree, scene.views, scene.viewpoint, 10);
    EXPECT_DOUBLE_EQ(later.next_change_s(), 11);
    update(later, scene.tree, scene.views, scene.viewpoint, 25);
    EXPECT_EQ(later.next_change_s(), never);
}

TEST(TemporalBsp, ABallIsAcrossWhileAPlanePasses) {
    const Scene scene = coming_box(Vec3d(-4, 0, 3), 0.5);
    TemporalBsp temporal = scene.at(0);
    EXPECT_DOUBLE_EQ(temporal.next_change_s(), 4.5);
    update(temporal, scene.tree, scene.views, scene.viewpoint, 4.75);
    const auto across = std::count_if(temporal.nodes.begin(), temporal.nodes.end(),
                                      [](const auto& node) { return node.side == PlaneSide::across; });
    EXPECT_EQ(across, 1);
    EXPECT_DOUBLE_EQ(temporal.next_change_s(), 5.5);
}

TEST(TemporalBsp, AFlatBoxOfViewpointsIsAcrossOnlyForPlanesItReaches) {
    Scene scene = coming_box(Vec3d(-4, 0, 3), 0.5);
    scene.viewpoint.half_extent_m = Vec3d(0, 0.3, 0.3);
    EXPECT_DOUBLE_EQ(scene.at(0).next_change_s(), 5);
    scene.viewpoint.half_extent_m = Vec3d(0.2, 0.3, 0.3);
    EXPECT_DOUBLE_EQ(scene.at(0).next_change_s(), 4.8);
    // The ball still limits a box that is larger.
    scene.viewpoint.half_extent_m = Vec3d(0.7, 0.3, 0.3);
    EXPECT_DOUBLE_EQ(scene.at(0).next_change_s(), 4.5);
}

TEST(TemporalBsp, EventsExactlyOnAPlaneAndTwoAtOneTimeTerminate) {
    // On the line where two planes meet, and exactly at the time of the event.
    const Scene scene = coming_box(Vec3d(-4, 1, 3));
    TemporalBsp temporal = scene.at(5);
    for (const double time : {5.0, 5.0, 5.0, 6.0, 7.0, 7.0, 10.0, 10.0, 12.0, 12.0}) {
        update(temporal, scene.tree, scene.views, scene.viewpoint, time);
        expect_same(temporal, scene.at(time));
        EXPECT_GE(temporal.next_change_s(), time);
    }
    Scene both = coming_box(Vec3d(-4, 0, 3));
    // Diagonally into the corner: two planes at one time.
    both.body.path.keys = {{0, {Vec3(-10, -6, 0), Quat(1, 0, 0, 0)}},
                           {10, {Vec3(0, 4, 0), Quat(1, 0, 0, 0)}}};
    both.ready();
    TemporalBsp corner = both.at(0);
    EXPECT_DOUBLE_EQ(corner.next_change_s(), 5);
    EXPECT_EQ(update(corner, both.tree, both.views, both.viewpoint, 5.0001).sides_changed, 2U);
    expect_same(corner, both.at(5.0001));
}

TEST(TemporalBsp, AtRestNothingEverChanges) {
    Scene scene = coming_box(Vec3d(0, 1, 3));
    scene.body.path.keys.clear();
    scene.ready();
    // The viewpoint lies in a face's plane and stays there.
    const TemporalBsp temporal = scene.at(0);
    EXPECT_EQ(temporal.next_change_s(), never);
    TemporalBsp later = temporal;
    EXPECT_EQ(update(later, scene.tree, scene.views, scene.viewpoint, 1e9).nodes_visited, 0U);
    EXPECT_EQ(make_temporal_bsp({}, scene.views, scene.viewpoint, 0).next_change_s(), never);
}

TEST(TemporalBsp, IntervalsDoNotSurviveAJump) {
    Scene scene = coming_box(Vec3d(-4, 0, 3));
    scene.body.path.keys = {{0, {Vec3(-10, 0, 0), Quat(1, 0, 0, 0)}},
                            {1, {Vec3(-9, 0, 0), Quat(1, 0, 0, 0)}},
                            {1, {Vec3(9, 0, 0), Quat(1, 0, 0, 0)}},
                            {2, {Vec3(10, 0, 0), Quat(1, 0, 0, 0)}}};
    scene.ready();
    TemporalBsp temporal = scene.at(0.5);
    EXPECT_DOUBLE_EQ(temporal.next_change_s(), 1);
    EXPECT_EQ(update(temporal, scene.tree, scene.views, scene.viewpoint, 1).sides_changed, 2U);
    expect_same(temporal, scene.at(1));
}

}  // namespace
}  // namespace afterglow
