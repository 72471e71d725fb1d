#include "solver/image/direct_light.h"

#include <array>

#include <gmock/gmock.h>

#include "solver/base/sampling.h"
#include "solver/formfactor/closed_forms.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::add_quad;
using testing::emission_of;
using testing::LinedWorld;

/// A lamp panel of radiance 1 over a floor so large that the panel counts as a lamp.
World lamp_world() {
    World world = testing::empty_world(0.5F);
    Body& body = world.bodies[furniture];
    add_quad(body, Vec3(-0.5F, 2, -0.25F), Vec3(1, 0, 0), Vec3(0, 0, 0.5F), 1);
    add_quad(body, Vec3(-20, 0, -20), Vec3(0, 0, 40), Vec3(40, 0, 0), 0);
    return world;
}

float mean_irradiance(const DirectLight& direct, const Vec3& point, const Vec3& normal,
                      std::size_t samples = 4096) {
    const SobolPoints points(samples);
    double sum = 0;
    for (std::size_t k = 0; k < samples; ++k) {
        const Sample4 s = points.at(k, 7);
        sum += static_cast<double>(direct.sample(point, normal, s[2], s[0], s[1]).irradiance.x);
    }
    return static_cast<float>(sum / static_cast<double>(samples));
}

/// Form factor from a point to the panel, exactly.
double to_panel(const Vec3& point, const Vec3& normal) {
    const std::array<Vec3d, 4> panel{Vec3d(-0.5, 2, -0.25), Vec3d(0.5, 2, -0.25), Vec3d(0.5, 2, 0.25),
                                     Vec3d(-0.5, 2, 0.25)};
    return point_to_polygon({Vec3d(point), Vec3d(normal)}, panel);
}

TEST(DirectLight, ARectangleGivesItsFormFactorNearAndFar) {
    const LinedWorld lined(lamp_world(), 0.25F * 8, 16);
    ASSERT_EQ(lined.lamps.list.size(), 1U);
    const DirectLight direct(lined.mesh, lined.lamps, lined.caster, emission_of(lined));
    for (const Vec3 point : {Vec3(0, 0, 0), Vec3(3, 0, 1), Vec3(0.3F, 1.9F, 0), Vec3(0.2F, 1.99F, 0.1F),
                             Vec3(0.6F, 1.95F, 0.3F), Vec3(15, 0, 0)}) {
        const double exact = static_cast<double>(pi) * to_panel(point, Vec3(0, 1, 0));
        EXPECT_NEAR(mean_irradiance(direct, point, Vec3(0, 1, 0)), exact, 2e-3 * exact)
            << point.x << " " << point.y;
    }
}

TEST(DirectLight, ATiltedReceiverSeesThePartAboveItsHorizon) {
    const LinedWorld lined(lamp_world(), 2, 16);
    const DirectLight direct(lined.mesh, lined.lamps, lined.caster, emission_of(lined));
    const Vec3 normal = glm::normalize(Vec3(1, 0.05F, 0));
    const Vec3 point(0, 1.5F, 0);
    const double exact = static_cast<double>(pi) * to_panel(point, normal);
    EXPECT_NEAR(mean_irradiance(direct, point, normal, 65536), exact, 5e-3 * exact);
}

TEST(DirectLight, NothingBehindTheLampOrBelowTheHorizonIsLit) {
    const LinedWorld lined(lamp_world(), 2, 16);
    const DirectLight direct(lined.mesh, lined.lamps, lined.caster, emission_of(lined));
    EXPECT_EQ(mean_irradiance(direct, Vec3(0, 3, 0), Vec3(0, -1, 0), 64), 0);
    EXPECT_EQ(mean_irradiance(direct, Vec3(0, 0, 0), Vec3(0, -1, 0), 64), 0);
    EXPECT_EQ(mean_irradiance(direct, Vec3(0, 2, 0), Vec3(0, 1, 0), 64), 0) << "in the lamp's plane";
}

TEST(DirectLight, SeveralLampsAddUp) {
    World world = lamp_world();
    Body& body = world.bodies[furniture];
    // A second panel of the same light, and a ball whose patches are no rectangles.
    add_quad(body, Vec3(4, 3, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), 1);
    testing::add_ball(body, Vec3(-4, 2, 0), 0.3F, 2, 1);
    const LinedWorld lined(std::move(world), 0.5F, 16);
    const auto emission = emission_of(lined);
    const DirectLight all(lined.mesh, lined.lamps, lined.caster, emission);
    const Vec3 point(1, 0, 0.5F), up(0, 1, 0);
    double one_by_one = 0;
    for (const Lamp& lamp : lined.lamps.list) {
        Lamps single = lined.lamps;
        single.list = {lamp};
        one_by_one += static_cast<double>(
            mean_irradiance({lined.mesh, single, lined.caster, emission}, point, up, 65536));
    }
    EXPECT_GT(lined.lamps.list.size(), 2U);
    EXPECT_NEAR(mean_irradiance(all, point, up, 65536), one_by_one, 4e-3 * one_by_one);
}

TEST(DirectLight, ALampThatIsOffIsNone) {
    const LinedWorld lined(lamp_world(), 2, 16);
    const std::vector<Rgb> dark(lined.mesh.size(), Rgb(0));
    const DirectLight direct(lined.mesh, lined.lamps, lined.caster, dark);
    EXPECT_TRUE(direct.empty());
    EXPECT_EQ(direct.sample(Vec3(0), Vec3(0, 1, 0), 0.5F, 0.5F, 0.5F).irradiance, Rgb(0));
}

TEST(RectangleLight, SolidAngleIsThatOfAPyramidOverItsWholeRange) {
    // A square of edge 2a seen from height h above its middle: 4 asin(a² / (a² + h²)).
    for (const float h : {0.001F, 0.1F, 1.0F, 3.0F}) {
        const RectangleLight light{Vec3(-1, 0, -1), Vec3(0, 0, 2), Vec3(2, 0, 0)};
        const double exact = 4 * std::asin(1 / (1 + static_cast<double>(h * h)));
        EXPECT_NEAR(RectangleView(light, Vec3(0, h, 0)).at(0.3F, 0.8F).solid_angle, exact, 1e-4 * exact);
    }
}

TEST(RectangleLight, PointsLieOnItAndAreUniformInSolidAngle) {
    const RectangleLight light{Vec3(-1, 0, -1), Vec3(0, 0, 2), Vec3(2, 0, 0)};
    const Vec3 from(0.7F, 0.2F, -0.4F);
    const SobolPoints points(4096);
    // The share of samples in a half must be that half's share of the solid angle.
    const RectangleLight half{Vec3(-1, 0, -1), Vec3(0, 0, 2), Vec3(1, 0, 0)};
    const float share =
        RectangleView(half, from).at(0, 0).solid_angle / RectangleView(light, from).at(0, 0).solid_angle;
    int in_half = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Sample4 s = points.at(k, 3);
        const Vec3 at = RectangleView(light, from).at(s[0], s[1]).position;
        EXPECT_NEAR(at.y, 0, 1e-5);
        EXPECT_LE(std::max(std::abs(at.x), std::abs(at.z)), 1 + 1e-5F);
        if (at.x < 0) ++in_half;
    }
    EXPECT_NEAR(static_cast<float>(in_half) / 4096, share, 5e-3);
}

}  // namespace
}  // namespace afterglow
