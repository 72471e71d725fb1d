#include "solver/formfactor/outside_light.h"

#include <cmath>

#include <gmock/gmock.h>

#include "solver/visibility/strategy.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::add_quad;
using testing::LinedWorld;

Light light_of(Light::Kind kind) {
    Light light;
    light.kind = kind;
    light.intensity = Rgb(10);
    light.inner_cone_angle = 0.3F;
    light.outer_cone_angle = 0.6F;
    return light;
}

TEST(LightAt, APointLightFallsWithTheSquareOfTheDistance) {
    const Light light = light_of(Light::Kind::point);
    const Pose at{Vec3(0, 2, 0), Quat(1, 0, 0, 0)};
    EXPECT_NEAR(light_at(light, at, Vec3(0), Vec3(0, 1, 0)).irradiance.x, 10 / 4.0, 1e-6);
    // 45° off: twice the squared distance, and the cosine.
    EXPECT_NEAR(light_at(light, at, Vec3(2, 0, 0), Vec3(0, 1, 0)).irradiance.x, 10 / 8.0 / std::sqrt(2.0),
                1e-6);
    EXPECT_EQ(light_at(light, at, Vec3(0), Vec3(0, -1, 0)).irradiance.x, 0);
}

TEST(LightAt, ASpotLightEndsAtItsOuterCone) {
    const Light light = light_of(Light::Kind::spot);
    const Pose down{Vec3(0, 1, 0), glm::angleAxis(-pi / 2, Vec3(1, 0, 0))};
    const auto at = [&](float angle) {
        return light_at(light, down, Vec3(std::tan(angle), 0, 0), Vec3(0, 1, 0)).irradiance.x;
    };
    EXPECT_NEAR(at(0), 10, 1e-4);
    EXPECT_GT(at(0.45F), 0);
    EXPECT_LT(at(0.45F), 10 * std::pow(std::cos(0.45F), 3));
    EXPECT_EQ(at(0.65F), 0);
}

TEST(LightAt, ADirectionalLightDoesNotFallOff) {
    const Light light = light_of(Light::Kind::directional);
    const Pose down{Vec3(0), glm::angleAxis(-pi / 2, Vec3(1, 0, 0))};
    EXPECT_NEAR(light_at(light, down, Vec3(0, -100, 0), Vec3(0, 1, 0)).irradiance.x, 10, 1e-4);
}

TEST(OutsideLight, BackgroundAndShadowedLight) {
    World world = testing::empty_world();
    world.background = Rgb(0.5F);
    add_quad(world.bodies[furniture], Vec3(0), Vec3(0, 0, 1), Vec3(1, 0, 0), 0);
    PlacedLight light{light_of(Light::Kind::point), {}};
    light.path.keys = {{0, {Vec3(0.5F, 2, 0.5F), Quat(1, 0, 0, 0)}}};
    world.lights.push_back(light);
    const LinedWorld lined(std::move(world), 1, 16);
    VisibleLines visible = make_visible_lines(lined.mesh, lined.sight, lined.light);
    const StaticLines none;
    make_retrace()->update({lined.mesh, lined.sight, lined.light, lined.caster, none}, {0, 16}, visible,
                           Context(1));
    const FormFactors factors = compile_rows(lined.mesh, lined.sight, lined.light, lined.lamps, lined.caster,
                                             {visible.patch, 16, {}}, Context(1));
    std::uint64_t rays = 0;
    const auto sky = sky_irradiance(lined.world, factors.sky);
    const auto lit = light_irradiance(lights_at(lined.world, 0), lined.mesh, lined.sight, lined.caster,
                                      factors.valid_share, rays, Context(1));
    ASSERT_EQ(sky.size(), 2U);
    ASSERT_EQ(lit.size(), 2U);
    EXPECT_NEAR(sky[0].x, pi * 0.5, 1e-5);
    EXPECT_NEAR(sky[1].x, pi * 0.5, 1e-5);
    // Above about 10 / 4 W/m², a little less towards the corners; below nothing.
    EXPECT_NEAR(lit[0].x, 2.4, 0.15);
    EXPECT_EQ(lit[1].x, 0);
    EXPECT_EQ(rays, 8U);
}

}  // namespace
}  // namespace afterglow
