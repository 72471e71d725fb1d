#include "solver/visibility/depth_levels.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>

namespace afterglow {
namespace {

using ::testing::ElementsAre;

/// A number below n.
Index below(Index n, std::mt19937& random) {
    return std::uniform_int_distribution<Index>(0, n - 1)(random);
}

/// Reachability by trying all intermediate nodes, Warshall.
std::vector<std::vector<char>> reachable(const Successors& graph) {
    const std::size_t n = graph.size();
    std::vector<std::vector<char>> reach(n, std::vector<char>(n, 0));
    for (std::size_t from = 0; from < n; ++from)
        for (const Index to : graph[from]) reach[from][to] = 1;
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                if (reach[i][k] != 0 && reach[k][j] != 0) reach[i][j] = 1;
    return reach;
}

/// The definition, by repetition: a component's level is one more than the highest of its ancestors.
DepthLevels levels_by_definition(const Successors& graph) {
    const auto reach = reachable(graph);
    const auto n = static_cast<Index>(graph.size());
    DepthLevels levels{std::vector<Index>(n), std::vector<Index>(n, 0)};
    for (Index k = 0; k < n; ++k) {
        levels.component[k] = k;
        for (Index other = n; other-- > 0;)
            if (reach[k][other] != 0 && reach[other][k] != 0)
                levels.component[k] = std::min(levels.component[k], other);
    }
    for (Index round = 0; round < n; ++round)
        for (Index from = 0; from < n; ++from)
            for (Index to = 0; to < n; ++to)
                if (reach[from][to] != 0 && reach[to][from] == 0)
                    levels.level[to] = std::max(levels.level[to], levels.level[from] + 1);
    return levels;
}

TEST(DepthLevels, OfAChainAreItsPlaces) {
    EXPECT_THAT(sort_by_levels({{1}, {2}, {}}).level, ElementsAre(0U, 1U, 2U));
}

TEST(DepthLevels, AreTheLongestPaths) {
    // 0 → 3 directly and over 1 and 2.
    EXPECT_THAT(sort_by_levels({{1, 3}, {2}, {3}, {}}).level, ElementsAre(0U, 1U, 2U, 3U));
}

TEST(DepthLevels, CirclesAreOneNode) {
    const DepthLevels levels = sort_by_levels({{1}, {2}, {0, 3}, {}, {0}});
    EXPECT_THAT(levels.component, ElementsAre(0U, 0U, 0U, 3U, 4U));
    EXPECT_THAT(levels.level, ElementsAre(1U, 1U, 1U, 2U, 0U));
    EXPECT_THAT(front_to_back(levels), ElementsAre(4U, 0U, 1U, 2U, 3U));
}

TEST(DepthLevels, OfNothing) {
    EXPECT_EQ(sort_by_levels({}), DepthLevels{});
    EXPECT_EQ(sort_by_levels({{0}}).level, std::vector<Index>{0});
}

TEST(DepthLevels, ManyNodesInOneCircleOrChainTerminate) {
    Successors circle(20'000);
    for (Index k = 0; k < circle.size(); ++k) circle[k] = {(k + 1) % static_cast<Index>(circle.size())};
    const DepthLevels one = sort_by_levels(circle);
    EXPECT_EQ(*std::max_element(one.level.begin(), one.level.end()), 0U);
    circle.back().clear();
    EXPECT_EQ(sort_by_levels(circle).level.back(), 19'999U);
}

TEST(DepthLevels, StayRightWhileEdgesComeAndGo) {
    std::mt19937 random(7);
    std::size_t with_circles = 0;
    for (int round = 0; round < 60; ++round) {
        const Index n = 2 + below(11, random);
        Successors graph(n);
        DepthLevels levels = sort_by_levels(graph);
        for (int step = 0; step < 40; ++step) {
            std::vector<Index> heads;
            for (Index changes = 1 + below(3, random); changes > 0; --changes) {
                const Index from = below(n, random), to = below(n, random);
                if (from == to) continue;
                auto& successors = graph[from];
                const auto at = std::lower_bound(successors.begin(), successors.end(), to);
                if (at != successors.end() && *at == to)
                    successors.erase(at);
                else
                    successors.insert(at, to);
                heads.push_back(to);
            }
            const std::size_t sorted = resort_by_levels(levels, graph, heads);
            ASSERT_LE(sorted, n);
            const DepthLevels expected = levels_by_definition(graph);
            ASSERT_EQ(levels, expected);
            ASSERT_EQ(sort_by_levels(graph), expected);
            for (Index k = 0; k < n; ++k) with_circles += expected.component[k] != k ? 1U : 0U;
        }
    }
    EXPECT_GT(with_circles, 1000U);
}

}  // namespace
}  // namespace afterglow
