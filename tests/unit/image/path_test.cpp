#include "solver/image/path.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "tests/support/brute_force.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::add_box;
using testing::add_quad;
using testing::Facing;

/// Mean of samples and its standard error, by channel r.
struct Estimate {
    double mean = 0, standard_error = 0;
};

template <class SampleOf>
Estimate estimate(int count, const SampleOf& sample_of) {
    double sum = 0, squares = 0;
    for (int k = 0; k < count; ++k) {
        const double value = sample_of(k);
        sum += value;
        squares += value * value;
    }
    const double mean = sum / count;
    return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / (count - 1))};
}

/// A world at a time, ready to be path-traced; lamps as `config` finds them.
struct TracedWorld {
    World world;
    RayCaster caster;
    PatchMesh mesh;
    std::vector<Material> materials;
    std::vector<LightInPlace> lights;
    std::vector<Rgb> emission;
    Lamps lamps;
    std::optional<DirectLight> direct;
    std::uint64_t rays = 0;

    explicit TracedWorld(World w, double time_s = 0, const LampConfig& config = {})
        : world(std::move(w)),
          caster(world),
          mesh(testing::LinedWorld::mesh_all(world, 0.5F)),
          lights(lights_at(world, time_s)) {
        caster.set_poses(poses_at(world, time_s));
        for (Index m = 0; m < world.materials.size(); ++m) materials.push_back(material_at(world, m, time_s));
        for (Index p = 0; p < mesh.size(); ++p) {
            const Rgb radiance = materials[mesh.material(p)].emission;
            emission.push_back(is_emitter(world, mesh, p) ? pi * radiance : Rgb(0));
        }
        lamps = find_lamps(world, mesh, config);
        direct.emplace(mesh, lamps, caster, emission);
    }
    TracedWorld(const TracedWorld&) = delete;
    TracedWorld& operator=(const TracedWorld&) = delete;

    [[nodiscard]] PathScene scene() const { return {&world, &caster, materials, &*direct, lights, 1e-4F}; }
    Rgb radiance(const Ray& ray, std::uint64_t seed) {
        RandomStream random(mixed(seed));
        return path_radiance(scene(), {}, ray, random, rays);
    }
};

/// Everything shines and reflects alike, on all sides: L = L_e / (1 − ρ) along every ray (closed form 7).
World furnace(float reflectance) {
    World world = testing::small_room();
    world.materials[0] = testing::diffuse("furnace", Rgb(reflectance), Rgb(1));
    world.materials[0].shines = Material::Shines::both;
    world.materials[1] = world.materials[0];
    return world;
}

/// Which shining sides of the furnace count as lamps: none, the smaller ones, all. A lamp counted twice or
/// not at all would show.
class FurnaceLamps : public ::testing::TestWithParam<LampConfig> {};
INSTANTIATE_TEST_SUITE_P(Path, FurnaceLamps,
                         ::testing::Values(LampConfig{}, LampConfig{0.02F, 0, 0.3F}, LampConfig{1, 0, 0.3F}));

TEST_P(FurnaceLamps, GiveTheExactMean) {
    for (const float reflectance : {0.3F, 0.8F}) {
        TracedWorld traced(furnace(reflectance), 0.6, GetParam());
        const Estimate light = estimate(20000, [&](int k) {
            const Vec3 towards = cosine_direction(static_cast<float>(k) / 20000, 0.3F);
            return traced.radiance({Vec3(2, 1.5F, 2.3F), towards}, static_cast<std::uint64_t>(k)).x;
        });
        EXPECT_NEAR(light.mean, 1 / (1 - reflectance), 3 * light.standard_error) << reflectance;
        EXPECT_LT(light.standard_error, 0.05);
    }
}

TEST(Path, TheFurnaceCasesDifferInTheirLamps) {
    const auto lamps = [](const LampConfig& config) {
        return TracedWorld(furnace(0.5F), 0, config).lamps.patches.size();
    };
    const std::size_t some = lamps({0.02F, 0, 0.3F}), all = lamps({1, 0, 0.3F});
    EXPECT_EQ(lamps({}), 0U);
    EXPECT_GT(some, 0U);
    EXPECT_GT(all, some);
}

PlacedLight light_above(Light::Kind kind, float height) {
    PlacedLight light;
    light.light.kind = kind;
    light.light.intensity = Rgb(10, 5, 1);
    light.path.keys = {{0, {Vec3(0, height, 0), glm::angleAxis(-pi / 2, Vec3(1, 0, 0))}}};
    return light;
}

TEST(Path, ALightOverAPlaneHasItsClosedForm) {
    World world = testing::empty_world(0.6F);
    add_quad(world.bodies[furniture], Vec3(-5, 0, -5), Vec3(0, 0, 10), Vec3(10, 0, 0), 0);
    world.lights = {light_above(Light::Kind::point, 2)};
    TracedWorld point(world);
    world.lights = {light_above(Light::Kind::directional, 2)};
    TracedWorld directional(world);
    for (const float x : {0.0F, 1.0F, 3.0F}) {
        const Ray ray{Vec3(x, 1, 0), Vec3(0, -1, 0)};
        const double distance = std::hypot(2.0, x);
        // One reflection into the open: no chance is left, only rounding and the lift of 1e-4 m.
        const double expected = 0.6 / pi * 10 * 2 / std::pow(distance, 3);
        EXPECT_NEAR(point.radiance(ray, 1).x, expected, 2e-4 * expected) << x;
        EXPECT_NEAR(point.radiance(ray, 1).y, expected / 2, 1e-4 * expected) << x;
        EXPECT_NEAR(directional.radiance(ray, 1).x, 0.6 / pi * 10, 1e-5) << x;
    }
    EXPECT_EQ(point.radiance({Vec3(0, 1, 0), Vec3(0, 1, 0)}, 1), Rgb(0)) << "the light itself is not seen";
}

TEST(Path, SeesLampsBackgroundAndTexture) {
    World world = testing::empty_world(0.5F);
    world.background = Rgb(0.25F, 0.5F, 2);
    Body& body = world.bodies[furniture];
    add_quad(body, Vec3(0), Vec3(0, 0, 1), Vec3(1, 0, 0), 0);
    add_quad(body, Vec3(5, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0), 1);
    body.texture_coordinates = {{0, 0}, {0, 1}, {1, 1}, {1, 0}, {}, {}, {}, {}};
    // Left half black, right half white.
    world.textures.push_back({"halves", 2, 1, {0, 0, 0, 255, 255, 255, 255, 255}});
    world.materials[0].texture = 0;
    TracedWorld traced(world);
    const auto from_above = [&](float x) { return traced.radiance({Vec3(x, 1, 0.5F), Vec3(0, -1, 0)}, 1); };
    EXPECT_EQ(from_above(-3), world.background);
    EXPECT_EQ(from_above(0.25F), Rgb(0));
    EXPECT_EQ(from_above(5.5F), Rgb(1)) << "a lamp that shadow rays sample is still seen by the camera";
    EXPECT_EQ(traced.radiance({Vec3(5.5F, -1, 0.5F), Vec3(0, 1, 0)}, 1), Rgb(0)) << "its back is dark";
    // The lamp covers little of the sky, which gives π L to a patch that sees nothing else.
    const Estimate white = estimate(4000, [&](int k) {
        RandomStream random(mixed(static_cast<std::uint64_t>(k)));
        return path_radiance(traced.scene(), {}, {Vec3(0.75F, 1, 0.5F), Vec3(0, -1, 0)}, random, traced.rays)
            .y;
    });
    EXPECT_NEAR(white.mean, 0.5 * 0.5, 3 * white.standard_error + 1e-6);
}

TEST(Path, MeanIndirectLightOfAClosedCubeIsTheCies) {
    // CIE 171:2006 case 5.8: average indirect illuminance (Φ/96) ρ/(1−ρ) in a cube of 4 m with 10,000 lm.
    for (const float reflectance : {0.1F, 0.5F, 0.9F, 0.95F}) {
        World world = testing::empty_world(reflectance);
        add_box(world.bodies[furniture], Vec3(0), Vec3(4), 0, Facing::inwards);
        PlacedLight light;
        light.light.intensity = Rgb(10000 / (4 * pi));
        light.path.keys = {{0, {Vec3(2), Quat(1, 0, 0, 0)}}};
        world.lights.push_back(light);
        TracedWorld traced(world);
        RandomStream places(7);
        const Estimate illuminance = estimate(40000, [&](int k) {
            // A point of one of the six faces and the ray that a cosine-weighted receiver there sends out.
            const int axis = k % 3;
            Vec3 point(4 * places.next(), 4 * places.next(), 4 * places.next()), normal(0);
            point[axis] = k % 2 == 0 ? 1e-4F : 4 - 1e-4F;
            normal[axis] = k % 2 == 0 ? 1.0F : -1.0F;
            const float u = places.next(), v = places.next();
            const Ray ray{point, Frame(normal).to_world(cosine_direction(u, v))};
            return pi * traced.radiance(ray, static_cast<std::uint64_t>(k)).x;
        });
        const double expected = 10000.0 / 96 * reflectance / (1 - reflectance);
        EXPECT_NEAR(illuminance.mean, expected, 3 * illuminance.standard_error) << reflectance;
        EXPECT_LT(illuminance.standard_error, 0.02 * expected);
    }
}

/// The same light by other means: visibility by trying every triangle in double precision, no shadow rays
/// (lamps count where they are met), a fixed chance to go on, generators of the standard library.
double by_brute_force(const TracedWorld& traced, std::span<const Pose> poses, Ray ray, std::mt19937& random) {
    constexpr double goes_on = 0.7;
    std::uniform_real_distribution<double> unit(0, 1);
    double radiance = 0, throughput = 1;
    while (true) {
        const Hit hit = testing::nearest_by_brute_force(traced.world, poses, ray, Scope::everything);
        if (hit.body == no_index) return radiance + throughput * traced.world.background.x;
        const Body& body = traced.world.bodies[hit.body];
        const Material& material = traced.materials[body.triangles[hit.triangle].material];
        if (hit.side == Side::front) radiance += throughput * material.emission.x;
        if (unit(random) >= goes_on) return radiance;
        throughput *= material.reflectance.x / goes_on;
        if (throughput <= 0) return radiance;
        Vec3 normal = poses[hit.body].direction(glm::normalize(doubled_area_normal(body, hit.triangle)));
        if (hit.side == Side::back) normal = -normal;
        // Uniform on the unit sphere around the normal's tip: cosine-weighted around the normal.
        const double z = 1 - 2 * unit(random), angle = 2 * static_cast<double>(pi) * unit(random);
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        const Vec3 on_sphere(glm::dvec3(r * std::cos(angle), r * std::sin(angle), z));
        ray = {ray.origin + hit.distance * ray.direction + 1e-4F * normal,
               glm::normalize(normal + 0.999999F * on_sphere)};
    }
}

TEST(Path, AgreesWithBruteForceWhileAnActorTurns) {
    World world = testing::small_room();
    // Large enough to be met by chance, small enough to be a lamp.
    add_quad(world.bodies[furniture], Vec3(0.01F, 0.5F, 1), Vec3(0, 2, 0), Vec3(0, 0, 2), 1);
    world.background = Rgb(0.3F);
    world.materials[0].reflectance = Rgb(0.7F);
    const double time_s = 0.7;
    TracedWorld traced(world, time_s);
    ASSERT_EQ(traced.lamps.list.size(), 2U);
    const auto poses = poses_at(traced.world, time_s);
    std::mt19937 random(3);
    for (const Vec3& towards : {Vec3(-1.4F, -1.2F, -2), Vec3(-0.6F, -0.6F, -2), Vec3(1, 0.4F, -1)}) {
        const Ray ray{Vec3(2, 1.5F, 4.7F), glm::normalize(towards)};
        const Estimate oracle =
            estimate(60000, [&](int) { return by_brute_force(traced, poses, ray, random); });
        const Estimate path = estimate(
            20000, [&](int k) { return traced.radiance(ray, 1000 + static_cast<std::uint64_t>(k)).x; });
        EXPECT_NEAR(path.mean, oracle.mean, 3 * std::hypot(path.standard_error, oracle.standard_error));
        EXPECT_LT(oracle.standard_error, 0.05 * oracle.mean);
    }
}

TEST(Path, PicturesAreTheSameForAnyNumberOfThreadsAndPixelByPixel) {
    TracedWorld traced(testing::small_room(), 0.4);
    const CameraView view = view_at(traced.world.cameras[0], 0.4, 24, 16);
    const PathPictureConfig config{4, 9, {}};
    std::uint64_t rays = 0, more = 0;
    const PathPicture one = trace_picture(view, traced.scene(), config, rays, Context(1));
    const PathPicture many = trace_picture(view, traced.scene(), config, more, Context(4));
    EXPECT_EQ(rays, more);
    EXPECT_GT(rays, 24U * 16U * 4U * 4U);
    for (const auto& [a, b] : {std::pair(&one.mean, &many.mean), std::pair(&one.variance, &many.variance)})
        EXPECT_EQ(std::memcmp(a->pixels.data(), b->pixels.data(), a->pixels.size() * sizeof(Rgb)), 0);
    const PathPixel pixel = trace_pixel(view, traced.scene(), config, 7, 11, rays);
    EXPECT_EQ(pixel.mean, one.mean.at(7, 11));
    EXPECT_EQ(pixel.variance, one.variance.at(7, 11));
    EXPECT_THROW(trace_picture(view, traced.scene(), {1, 1, {}}, rays, Context(1)), Error);
}

TEST(Path, TheVarianceIsThatOfIndependentPictures) {
    TracedWorld traced(testing::small_room(), 0.4);
    const CameraView view = view_at(traced.world.cameras[0], 0.4, 48, 32);
    std::uint64_t rays = 0;
    const PathPicture a = trace_picture(view, traced.scene(), {16, 1, {}}, rays, Context(2));
    const PathPicture b = trace_picture(view, traced.scene(), {16, 2, {}}, rays, Context(2));
    double squares = 0, variance = 0;
    for (std::size_t k = 0; k < a.mean.pixels.size(); ++k) {
        squares += std::pow(a.mean.pixels[k].x - b.mean.pixels[k].x, 2);
        variance += a.variance.pixels[k].x + b.variance.pixels[k].x;
    }
    // 1536 squares of differences, each with a relative spread of about √2: 4 % of the sum; three times that.
    EXPECT_NEAR(squares / variance, 1, 0.12);
}

}  // namespace
}  // namespace afterglow
