#include "solver/image/lamp_packet.h"

#include <gtest/gtest.h>

#include "solver/base/sampling.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::add_quad;
using testing::emission_of;
using testing::LinedWorld;

/// Two panels and a ball whose patches are no rectangles, in a dark box.
World lamps_world() {
    World world = testing::empty_world(0.5F);
    Body& body = world.bodies[furniture];
    add_quad(body, Vec3(-0.5F, 2, -0.25F), Vec3(1, 0, 0), Vec3(0, 0, 0.5F), 1);
    add_quad(body, Vec3(4, 3, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    testing::add_ball(body, Vec3(-4, 2, 0), 0.3F, 2, 1);
    add_quad(body, Vec3(-20, 0, -20), Vec3(0, 0, 40), Vec3(40, 0, 0), 0);
    return world;
}

/// Seen so edge-on, a packet chooses its places otherwise; see rectangle_packet_test.
bool is_edge_on(const DirectLight::Emitter& emitter, const Vec3& point) {
    return emitter.rectangle && RectangleView(*emitter.rectangle, point).is_near() &&
           RectangleView(*emitter.rectangle, point).at(0, 0).solid_angle < 0.006F;
}

TEST(LampPacket, GivesWhatEachPointWouldGetByItself) {
    const LinedWorld lined(lamps_world(), 0.5F, 16);
    const auto emission = emission_of(lined);
    const DirectLight direct(lined.mesh, lined.lamps, lined.caster, emission);
    ASSERT_GT(direct.emitters().size(), 2U);
    LampPacket packet(direct);
    RandomStream random(5);
    int alike = 0, lit = 0, all = 0;
    for (int round = 0; round < 500; ++round) {
        std::array<Vec3, 16> point, normal;
        PacketFloats choice, s, t;
        for (std::size_t lane = 0; lane < 16; ++lane) {
            point[lane] = Vec3(10 * random.next() - 5, 4 * random.next(), 6 * random.next() - 3);
            const Vec3 up = cosine_direction(random.next(), random.next());
            normal[lane] = lane % 2 == 0 ? up : -up;
            packet.set(lane, point[lane], normal[lane]);
        }
        packet.look();
        // The second time what was seen the first is used again.
        for (int again = 0; again < 2; ++again) {
            for (std::size_t lane = 0; lane < 16; ++lane) {
                choice[lane] = random.next();
                s[lane] = random.next();
                t[lane] = random.next();
            }
            LampPacketSamples samples;
            packet.sample(choice, s, t, samples);
            for (std::size_t lane = 0; lane < 16; ++lane) {
                const LightSample one =
                    direct.sample(point[lane], normal[lane], choice[lane], s[lane], t[lane]);
                const Rgb irradiance =
                    samples.share[lane] * direct.emitters()[samples.emitter[lane]].emission;
                const Vec3 towards(samples.direction_x[lane], samples.direction_y[lane],
                                   samples.direction_z[lane]);
                if (is_edge_on(direct.emitters()[samples.emitter[lane]], point[lane])) continue;
                ++all;
                if (one.irradiance.x > 0) ++lit;
                // Where a choice falls between two lamps rounding decides.
                const bool same_light =
                    std::abs(irradiance.x - one.irradiance.x) <= 1e-4F * one.irradiance.x + 1e-9F;
                const bool same_way =
                    one.irradiance.x <= 0 ||
                    (glm::length(towards - one.direction) < 1e-4F &&
                     std::abs(samples.distance_m[lane] - one.distance_m) < 1e-4F * one.distance_m);
                if (same_light && same_way) ++alike;
            }
        }
    }
    EXPECT_GT(lit, all / 4);
    EXPECT_GE(alike, all - all / 2000);
}

TEST(LampPacket, NothingBelowTheHorizonGivesLight) {
    const LinedWorld lined(lamps_world(), 0.5F, 16);
    const DirectLight direct(lined.mesh, lined.lamps, lined.caster, emission_of(lined));
    LampPacket packet(direct);
    for (std::size_t lane = 0; lane < 16; ++lane) packet.set(lane, Vec3(0, 0.1F, 0), Vec3(0, -1, 0));
    packet.look();
    PacketFloats half;
    half.fill(0.5F);
    LampPacketSamples samples;
    packet.sample(half, half, half, samples);
    for (const float share : samples.share) EXPECT_EQ(share, 0);
}

}  // namespace
}  // namespace afterglow
