#include "solver/image/rectangle_packet.h"

#include <gtest/gtest.h>

#include "solver/base/sampling.h"
#include "solver/image/rectangle_choice.h"
#include "tests/support/random_rectangles.h"

namespace afterglow {
namespace {

using testing::RandomRectangles;

struct Case {
    RectangleLight light;
    std::array<Vec3, 16> from, normal;
    PointPacket points;
};

template <class Place>
Case make_case(RandomRectangles& random, const Place& place) {
    Case out;
    out.light = random.rectangle();
    for (std::size_t k = 0; k < 16; ++k) {
        const Vec3 from = out.from[k] = place(out.light), normal = out.normal[k] = random.normal();
        out.points.x[k] = from.x;
        out.points.y[k] = from.y;
        out.points.z[k] = from.z;
        out.points.normal_x[k] = normal.x;
        out.points.normal_y[k] = normal.y;
        out.points.normal_z[k] = normal.z;
    }
    return out;
}

constexpr std::array<Index, 16> all_chosen{};

TEST(RectanglePacket, ChoosesThePlacesThatEachPointWouldChoose) {
    RandomRectangles random(1);
    RandomStream numbers(2);
    int compared = 0;
    for (int round = 0; round < 1000; ++round) {
        const Case c =
            make_case(random, [&](const RectangleLight& light) { return random.point_before(light); });
        PacketFloats s, t;
        for (std::size_t k = 0; k < 16; ++k) {
            s[k] = numbers.next();
            t[k] = numbers.next();
        }
        RectanglePacket packet;
        packet.look(c.light, c.points);
        PlacePacket places;
        packet.place(c.light, c.points, all_chosen, 0, s, t, places);
        for (std::size_t k = 0; k < 16; ++k) {
            // Seen more edge-on, it is chosen as from far off.
            if (RectangleView(c.light, c.from[k]).at(0, 0).solid_angle < 0.01F) continue;
            const RectanglePoint one = point_for(c.light, c.from[k], c.normal[k], s[k], t[k]);
            const Vec3 at(places.x[k], places.y[k], places.z[k]);
            EXPECT_NEAR(places.solid_angle[k], one.solid_angle, 2e-3F * one.solid_angle);
            EXPECT_LT(glm::length(at - one.position), 2e-3F * glm::length(c.light.edge_u + c.light.edge_v));
            ++compared;
        }
    }
    EXPECT_GT(compared, 8000);
}

TEST(RectanglePacket, GivesPointsTheirFormFactorAlsoEdgeOn) {
    RandomRectangles random(3);
    constexpr std::uint32_t count = 1U << 14U;
    const SobolPoints numbers(count);
    for (int round = 0; round < 20; ++round) {
        const Case c = make_case(random, [&](const RectangleLight& light) {
            const Vec3 before = random.point_before(light);
            const Vec3 up = RectangleAxes(light).normal;
            // Half of them hardly above the rectangle's plane.
            return round % 2 == 0 ? before : before - 0.99F * glm::dot(before - light.corner, up) * up;
        });
        RectanglePacket packet;
        packet.look(c.light, c.points);
        std::array<double, 16> mean{};
        for (std::uint32_t i = 0; i < count; ++i) {
            const Sample4 at = numbers.at(i, 5);
            PacketFloats s, t;
            s.fill(at[0]);
            t.fill(at[1]);
            PlacePacket places;
            packet.place(c.light, c.points, all_chosen, 0, s, t, places);
            for (std::size_t k = 0; k < 16; ++k)
                mean[k] += testing::irradiance_share(
                               {Vec3(places.x[k], places.y[k], places.z[k]), places.solid_angle[k]},
                               c.from[k], c.normal[k]) /
                           count;
        }
        for (std::size_t k = 0; k < 16; ++k) {
            const double exact = random.form_factor(c.light, c.from[k], c.normal[k]);
            EXPECT_NEAR(mean[k], exact, 0.02 * exact + 5e-5) << round << " " << k;
        }
    }
}

TEST(RectanglePacket, LeavesLanesAloneThatChoseAnother) {
    RandomRectangles random(4);
    const Case c = make_case(random, [&](const RectangleLight& light) { return random.point_before(light); });
    std::array<Index, 16> chosen;
    for (std::size_t k = 0; k < 16; ++k) chosen[k] = k % 2;
    RectanglePacket packet;
    packet.look(c.light, c.points);
    PlacePacket places;
    places.x.fill(-77);
    places.solid_angle.fill(-77);
    PacketFloats half;
    half.fill(0.5F);
    packet.place(c.light, c.points, chosen, 1, half, half, places);
    for (std::size_t k = 0; k < 16; ++k) EXPECT_EQ(places.solid_angle[k] == -77, k % 2 == 0) << k;
}

}  // namespace
}  // namespace afterglow
