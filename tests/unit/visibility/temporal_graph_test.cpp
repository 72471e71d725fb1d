#include "solver/visibility/temporal_graph.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/support/actors.h"
#include "tests/support/brute_force.h"

namespace afterglow {
namespace {

using ::testing::ElementsAre;

constexpr double never = std::numeric_limits<double>::infinity();

/// A number below n.
Index below(Index n, std::mt19937& random) {
    return std::uniform_int_distribution<Index>(0, n - 1)(random);
}

/// The levels at a time, from scratch.
DepthLevels levels_at(const TemporalGraph& graph, double time_s) {
    Successors active(graph.adjacency.size());
    for (Index from = 0; from < active.size(); ++from)
        for (Index to = 0; to < active.size(); ++to)
            for (const Hiding& edge : graph.adjacency[from])
                if (edge.to == to && edge.when.contains(time_s)) active[from].push_back(to);
    return sort_by_levels(active);
}

TEST(TemporalGraph, FollowsIntervalsThatBeginAndEnd) {
    TemporalGraph graph = make_temporal_graph({{{1, {1, 3}}}, {{2, {-never, 2}}}, {}});
    EXPECT_THAT(graph.levels.level, ElementsAre(0U, 0U, 1U));
    EXPECT_EQ(graph.until_s, 1);
    EXPECT_EQ(update(graph, 0.99).events, 0U);
    EXPECT_EQ(update(graph, 1).events, 1U);
    EXPECT_THAT(graph.levels.level, ElementsAre(0U, 1U, 2U));
    EXPECT_EQ(update(graph, 2).events, 1U);
    EXPECT_THAT(graph.levels.level, ElementsAre(0U, 1U, 0U));
    EXPECT_EQ(update(graph, 3).events, 1U);
    EXPECT_EQ(graph.until_s, never);
    EXPECT_EQ(update(graph, 0).events, 3U);
    EXPECT_THAT(graph.levels.level, ElementsAre(0U, 0U, 1U));
    // All that is over before the next look leaves no trace.
    EXPECT_EQ(update(graph, 10).events, 3U);
    EXPECT_THAT(graph.levels.level, ElementsAre(0U, 0U, 0U));
}

TEST(TemporalGraph, EqualsSortingFromScratchAfterEveryUpdate) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    std::uint64_t sorted = 0, nodes = 0;
    for (int round = 0; round < 60; ++round) {
        const Index n = 2 + below(11, random);
        std::vector<std::vector<Hiding>> adjacency(n);
        for (Index from = 0; from < n; ++from)
            for (Index to = 0; to < n; ++to) {
                if (from == to || unit(random) > 0.4) continue;
                // Times on a coarse grid: many fall together.
                double begin = std::floor(20 * unit(random));
                for (int k = 0; k < 3; ++k) {
                    const double end = begin + 1 + std::floor(3 * unit(random));
                    adjacency[from].push_back({to, {k == 0 && begin < 3 ? -never : begin, end}});
                    begin = end + 1 + std::floor(3 * unit(random));
                }
            }
        TemporalGraph graph = make_temporal_graph(adjacency);
        for (int step = 0; step < 80; ++step) {
            const double time = step % 20 == 19 ? 30 * unit(random) : 0.5 * step;
            sorted += update(graph, time).nodes_sorted;
            nodes += n;
            ASSERT_EQ(graph.levels, levels_at(graph, time)) << "round " << round << " time " << time;
            ASSERT_EQ(graph.order, front_to_back(graph.levels));
        }
    }
    EXPECT_LT(sorted, nodes);
}

/// The extents of a world's actors and their graph from a point.
struct SeenActors {
    World world;
    TimeTree times;
    std::vector<SpacetimeExtent> extents;
    TemporalGraph graph;

    SeenActors(World w, const Vec3& eye) : world(std::move(w)) {
        std::vector<Path> paths;
        for (const Body& body : world.bodies) paths.push_back(body.path);
        times = make_time_tree(paths, 0.1);
        for (std::size_t b = 1; b < world.bodies.size(); ++b) {
            Box box;
            for (const Vec3& p : world.bodies[b].positions) box.add(p);
            extents.push_back(swept_extent(box, paths[b], times, 1e-5F));
        }
        graph = make_temporal_graph(find_adjacencies(extents, resting_extent({eye, eye}), times));
    }
};

TEST(TemporalGraph, ItsOrderIsTheOrderAlongEveryRay) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(0, 1);
    int ordered = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        const Vec3 eye(4 * unit(random), 3 * unit(random), 5 * unit(random));
        SeenActors seen(
            testing::random_world(seed, 2 + static_cast<int>(seed % 8), testing::Movements::turning), eye);
        for (double time = -0.2; time < 4.3; time += 0.22) {
            update(seen.graph, time);
            const std::vector<Pose> poses = poses_at(seen.world, time);
            for (int k = 0; k < 60; ++k) {
                // At some actor, then on to whatever stands behind.
                const Index target = 1 + below(static_cast<Index>(seen.world.bodies.size()) - 1, random);
                const Vec3 jitter(unit(random) - 0.5F, unit(random) - 0.5F, unit(random) - 0.5F);
                Ray ray{eye, glm::normalize(poses[target].translation + 0.4F * jitter - eye)};
                Index before = no_index;
                for (;;) {
                    const Hit hit = testing::nearest_by_brute_force(seen.world, poses, ray, Scope::actors);
                    if (hit.body == no_index) break;
                    const Index actor = hit.body - 1;
                    if (before != no_index && before != actor) {
                        const DepthLevels& levels = seen.graph.levels;
                        ASSERT_TRUE(levels.component[before] == levels.component[actor] ||
                                    levels.level[before] < levels.level[actor]);
                        ordered += levels.component[before] != levels.component[actor] ? 1 : 0;
                    }
                    before = actor;
                    ray.origin += (hit.distance + 1e-4F) * ray.direction;
                }
            }
        }
    }
    EXPECT_GT(ordered, 100);
}

TEST(TemporalGraph, InterlockedRingsAndOverlappingBarsAreCircles) {
    SeenActors rings(testing::interlocked_rings(), Vec3(2, 1.5F, 0.2F));
    update(rings.graph, 0.5);
    EXPECT_THAT(rings.graph.levels.component, ElementsAre(0U, 0U));
    SeenActors bars(testing::overlapping_bars(), Vec3(2, 2.9F, 2.5F));
    update(bars.graph, 0.5);
    EXPECT_THAT(bars.graph.levels.component, ElementsAre(0U, 0U, 0U));
}

}  // namespace
}  // namespace afterglow
