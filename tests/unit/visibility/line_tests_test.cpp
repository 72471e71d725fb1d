#include "solver/visibility/line_tests.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/support/brute_force.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

struct Random {
    std::mt19937 engine;
    std::uniform_real_distribution<float> unit{-1, 1};

    Vec3 point() { return {unit(engine), unit(engine), unit(engine)}; }
    LinePacket packet(Index count) {
        LinePacket lines;
        lines.rays.count = count;
        for (std::size_t k = 0; k < count; ++k) {
            const Vec3 from = 3.0F * point();
            lines.rays.set(k, {from, glm::normalize(0.7F * point() - from)});
        }
        lines.prepare();
        return lines;
    }
};

TEST(LineTests, FacesAreMetWhereTheOracleMeetsThem) {
    Random random{std::mt19937(1)};
    int met = 0;
    for (int round = 0; round < 300; ++round) {
        World world = testing::empty_world();
        Body& body = world.bodies.front();
        body.positions = {random.point(), random.point(), random.point()};
        body.triangles.push_back({{0, 1, 2}, 0});
        const LinePacket lines = random.packet(13);
        std::array<float, 16> distance;
        meet(lines.rays, LineAxes(lines.rays),
             LineFace(body.positions[0], body.positions[1], body.positions[2]), distance);
        for (std::size_t k = 0; k < 16; ++k) {
            if (k >= lines.rays.count) continue;
            const Hit hit = testing::nearest_by_brute_force(world, poses_at(world, 0), lines.rays.ray(k),
                                                            Scope::everything);
            // Near an edge either answer is right.
            if (hit.body != no_index && testing::distance_from_edge(hit) < 1e-4) continue;
            if (hit.body == no_index) continue;
            EXPECT_NEAR(distance[k], hit.distance, 2e-4F);
            ++met;
        }
    }
    EXPECT_GT(met, 300);
}

TEST(LineTests, NoLineSlipsThroughASharedEdgeOrCorner) {
    // A closed fan around the origin; all lines aim at its edges and its middle.
    Random random{std::mt19937(2)};
    for (int round = 0; round < 20'000; ++round) {
        std::vector<Vec3> rim;
        for (int k = 0; k < 7; ++k)
            rim.push_back(0.3F * random.point() + Vec3(std::cos(0.8976F * static_cast<float>(k)),
                                                       std::sin(0.8976F * static_cast<float>(k)), 0));
        LinePacket lines;
        lines.rays.count = 16;
        for (std::size_t k = 0; k < 16; ++k) {
            const Vec3 from(random.unit(random.engine), random.unit(random.engine), 4);
            const float share = k < 4 ? 0.0F : 0.5F * (1 + random.unit(random.engine));
            lines.rays.set(k, {from, glm::normalize(0.7F * share * rim[k % 7] - from)});
        }
        lines.prepare();
        const LineAxes axes(lines.rays);
        std::uint32_t met = 0;
        for (std::size_t k = 0; k < 7; ++k) {
            std::array<float, 16> distance;
            meet(lines.rays, axes, LineFace(Vec3(0), rim[k], rim[(k + 1) % 7]), distance);
            for (std::size_t lane = 0; lane < 16; ++lane)
                if (distance[lane] < 100) met |= 1U << lane;
        }
        ASSERT_EQ(met, 0xFFFFU);
    }
}

TEST(LineTests, BoxesAreMetByTheLinesThatReachThem) {
    Random random{std::mt19937(3)};
    int through = 0;
    for (int round = 0; round < 300; ++round) {
        LinePacket lines = random.packet(16);
        for (std::size_t k = 0; k < 16; k += 3) lines.rays.far[k] = 2.5F;
        // Lines along the axes too.
        lines.rays.direction_x[0] = lines.rays.direction_y[0] = 0;
        lines.rays.direction_z[0] = 1;
        lines.prepare();
        const Vec3 a = random.point(), b = random.point();
        const Box box{glm::min(a, b), glm::max(a, b)};
        const std::uint32_t mask = lanes_through(lines, box);
        for (std::size_t k = 0; k < 16; ++k) {
            const Ray ray = lines.rays.ray(k);
            bool inside = false;
            for (int step = 0; step < 2000 && !inside; ++step) {
                const float at = std::min(ray.far, 8.0F) * static_cast<float>(step) / 2000;
                const Vec3 p = ray.origin + at * ray.direction;
                inside =
                    glm::all(glm::greaterThanEqual(p, box.low)) && glm::all(glm::lessThanEqual(p, box.high));
            }
            EXPECT_TRUE(!inside || ((mask >> k) & 1U) != 0);
            through += inside ? 1 : 0;
        }
        // Nothing is claimed of lines that pass by at a distance.
        const Box beside{Vec3(50), Vec3(51)};
        for (std::size_t k = 0; k < 16; ++k) lines.rays.far[k] = 40;
        EXPECT_EQ(lanes_through(lines, beside), 0U);
    }
    EXPECT_GT(through, 300);
}

TEST(LineTests, BodiesSeeTheSameDistances) {
    Random random{std::mt19937(4)};
    const LinePacket lines = random.packet(16);
    const Pose pose{Vec3(1, 2, 3), glm::angleAxis(0.8F, glm::normalize(Vec3(1, 2, -1)))};
    LinePacket local;
    to_body(lines.rays, pose, local);
    for (std::size_t k = 0; k < 16; ++k) {
        const Ray there = local.rays.ray(k), here = lines.rays.ray(k);
        EXPECT_LT(glm::length(pose.point(there.origin + 2.0F * there.direction) -
                              (here.origin + 2.0F * here.direction)),
                  1e-5F);
    }
}

}  // namespace
}  // namespace afterglow
