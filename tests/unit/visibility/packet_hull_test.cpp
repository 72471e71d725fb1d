#include "solver/visibility/packet_hull.h"

#include <random>

#include <gmock/gmock.h>

namespace afterglow {
namespace {

constexpr float reach_m = 10;

bool comes_into(const Ray& ray, const Box& box) {
    float first = 0, last = std::min(ray.far, 100.0F);
    for (int k = 0; k < 3; ++k) {
        const float a = (box.low[k] - ray.origin[k]) / ray.direction[k],
                    b = (box.high[k] - ray.origin[k]) / ray.direction[k];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return ray.far > 0 && first <= last;
}

TEST(PacketHull, IsMetWhereverARayIs) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-4, 4), unit(0, 1);
    const auto point = [&](auto& of) { return Vec3(of(random), of(random), of(random)); };
    int met = 0, left_out = 0;
    for (int trial = 0; trial < 20'000; ++trial) {
        const Vec3 from = point(place), to = point(place);
        const float spread = 0.5F * unit(random);
        RayPacket rays;
        rays.count = static_cast<Index>(1 + trial % 16);
        for (std::size_t l = 0; l < 16; ++l) {
            const Vec3 origin = from + spread * point(unit), way = to + spread * point(unit) - origin;
            const float far = l % 3 == 0   ? std::numeric_limits<float>::infinity()
                              : l % 7 == 6 ? 0.0F
                                           : glm::length(way);
            rays.set(l, {origin, glm::normalize(way), far});
        }
        Box box;
        box.add(point(place));
        box.add(box.low + 3.0F * point(unit));
        bool any = false;
        for (std::size_t l = 0; l < rays.count; ++l) any = any || comes_into(rays.ray(l), box);
        const bool may = PacketHull(rays, reach_m).may_meet(box);
        EXPECT_TRUE(may || !any) << trial;
        met += any ? 1 : 0;
        left_out += may ? 0 : 1;
    }
    EXPECT_GT(met, 500);
    EXPECT_GT(left_out, 5000);
}

TEST(PacketHull, OfRaysWithoutLengthMeetsNothing) {
    RayPacket rays;
    rays.count = 2;
    rays.set(0, {Vec3(0), Vec3(0, 0, 1), 0});
    rays.set(1, {Vec3(0), Vec3(0, 1, 0), 0});
    Box all;
    all.add(Vec3(-9));
    all.add(Vec3(9));
    EXPECT_FALSE(PacketHull(rays, reach_m).may_meet(all));
}

}  // namespace
}  // namespace afterglow
