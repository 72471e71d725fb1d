#include "solver/scene/triangulate.h"

#include <cmath>
#include <random>
#include <set>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "solver/scene/area.h"

namespace afterglow {
namespace {

double polygon_area(const std::vector<Vec3>& corners) {
    glm::dvec3 sum(0);
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
        sum += glm::cross(glm::dvec3(corners[k] - corners[0]), glm::dvec3(corners[k + 1] - corners[0]));
    return 0.5 * glm::length(sum);
}

/// Triangles cover the polygon once: areas add up without sign, and every triangle faces the polygon's way.
void expect_covers(const std::vector<Vec3>& corners, const Vec3& normal) {
    const auto result = triangulated(corners);
    EXPECT_TRUE(result.is_simple);
    EXPECT_EQ(result.triangles.size(), corners.size() - 2);
    double sum = 0;
    std::set<std::uint32_t> used;
    for (const auto& [a, b, c] : result.triangles) {
        sum += area(corners[a], corners[b], corners[c]);
        used.insert({a, b, c});
        const Vec3 own = glm::cross(corners[b] - corners[a], corners[c] - corners[a]);
        EXPECT_GE(glm::dot(own, normal), -1e-5F);
    }
    // Without sign the areas exceed the polygon's as soon as one triangle sticks out.
    EXPECT_NEAR(sum, polygon_area(corners), 1e-5 * polygon_area(corners));
    EXPECT_EQ(used.size(), corners.size());
}

TEST(Triangulated, CutsAnL) {
    expect_covers({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, {0, 0, 1});
    // From a corner whose fan would leave the outline, and seen from behind.
    expect_covers({{0, 2, 0}, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}}, {0, 0, 1});
    expect_covers({{0, 2, 0}, {1, 2, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}, {0, 0, 0}}, {0, 0, -1});
}

TEST(Triangulated, CutsRandomStarsInAnyPlane) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int round = 0; round < 300; ++round) {
        // A star-shaped outline is simple whatever its radii are.
        const int n = 3 + static_cast<int>(random() % 40);
        const Quat turn = glm::normalize(Quat(unit(random), unit(random), unit(random), unit(random)));
        std::vector<Vec3> corners;
        for (int k = 0; k < n; ++k) {
            const float angle =
                2 * pi * (static_cast<float>(k) + 0.8F * unit(random)) / static_cast<float>(n);
            const float radius = 0.2F + unit(random);
            corners.push_back(turn * (radius * Vec3(std::cos(angle), std::sin(angle), 0)) + Vec3(3, 1, 2));
        }
        if (n > 4) expect_covers(corners, turn * Vec3(0, 0, 1));
    }
}

TEST(Triangulated, CutsAFrameJoinedByADoubleEdge) {
    // A square with a square hole: two edges run along the same line in opposite directions.
    expect_covers({{0, 0, 0},
                   {3, 0, 0},
                   {3, 3, 0},
                   {0, 3, 0},
                   {0, 0, 0},
                   {1, 1, 0},
                   {1, 2, 0},
                   {2, 2, 0},
                   {2, 1, 0},
                   {1, 1, 0}},
                  {0, 0, 1});
}

TEST(Triangulated, KeepsAConvexPolygonOfAnySizeAFan) {
    std::vector<Vec3> circle;
    for (int k = 0; k < 5000; ++k) {
        const float angle = 2 * pi * static_cast<float>(k) / 5000;
        circle.emplace_back(1000 * std::cos(angle), 0, -1000 * std::sin(angle));
    }
    const auto result = triangulated(circle);
    EXPECT_EQ(result.triangles.size(), 4998U);
    EXPECT_THAT(result.triangles.back(), testing::ElementsAre(0, 4998, 4999));
}

TEST(Triangulated, SaysWhereAnOutlineCrossesItself) {
    const std::vector<Vec3> bow_tie{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1.5F, 0}};
    EXPECT_EQ(triangulated(bow_tie).triangles.size(), 2U);
    EXPECT_FALSE(triangulated(bow_tie).is_simple);
}

TEST(Triangulated, HandlesPolygonsWithoutArea) {
    const std::vector<Vec3> flat{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 0}};
    EXPECT_EQ(triangulated(flat).triangles.size(), 2U);
    EXPECT_EQ(triangulated(std::vector<Vec3>(6, Vec3(1))).triangles.size(), 4U);
}

TEST(Triangulated, RefusesHugeConcavePolygons) {
    std::vector<Vec3> comb;
    for (int k = 0; k < 600; ++k) {
        comb.emplace_back(k, k % 2 == 0 ? 1 : 2, 0);
        comb.emplace_back(k, 5, 0);
    }
    EXPECT_THROW(triangulated(comb), Error);
}

}  // namespace
}  // namespace afterglow
