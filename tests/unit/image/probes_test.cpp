#include "solver/image/probes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stop_token>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "tests/support/lined_world.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

/// A world at a time and a camera's view of it, ready to be probed.
struct ProbedWorld {
    World world;
    RayCaster caster;
    PatchMesh mesh;
    std::vector<Material> materials;
    std::vector<LightInPlace> lights;
    std::vector<Rgb> emission;
    Lamps lamps;
    std::optional<DirectLight> direct;
    CameraView view;

    explicit ProbedWorld(World w, int width = 48, int height = 32)
        : world(std::move(w)),
          caster(world),
          mesh(testing::LinedWorld::mesh_all(world, 0.5F)),
          lights(lights_at(world, 0)) {
        caster.set_poses(poses_at(world, 0));
        for (Index m = 0; m < world.materials.size(); ++m) materials.push_back(material_at(world, m, 0));
        for (Index p = 0; p < mesh.size(); ++p) {
            const Rgb radiance = materials[mesh.material(p)].emission;
            emission.push_back(is_emitter(world, mesh, p) ? pi * radiance : Rgb(0));
        }
        lamps = find_lamps(world, mesh, {});
        direct.emplace(mesh, lamps, caster, emission);
        view = view_at(world.cameras[0], 0, width, height);
    }
    ProbedWorld(const ProbedWorld&) = delete;
    ProbedWorld& operator=(const ProbedWorld&) = delete;

    [[nodiscard]] PathScene scene() const { return {&world, &caster, materials, &*direct, lights, 1e-4F}; }
    [[nodiscard]] PathPicture traced(int samples) const {
        std::uint64_t rays = 0;
        return trace_picture(view, scene(), {samples, 77, {}}, rays, Context());
    }
    ProbeEstimate estimate(const Picture& picture, const ProbeConfig& config = {},
                           const Context& context = Context()) const {
        std::uint64_t rays = 0;
        return estimate_error(picture, view, scene(), config, rays, context);
    }
};

/// Everything shines and reflects alike: L = L_e / (1 − ρ) along every ray (closed form 7).
World furnace(float reflectance) {
    World world = testing::small_room();
    world.materials[0] = testing::diffuse("furnace", Rgb(reflectance), Rgb(1));
    world.materials[0].shines = Material::Shines::both;
    world.materials[1] = world.materials[0];
    return world;
}

Picture uniform(const CameraView& view, float value) {
    Picture picture(view.width, view.height);
    for (Rgb& pixel : picture.pixels) pixel = Rgb(value);
    return picture;
}

/// How many standard errors the square of an estimate lies from the square it should be.
double score(const ProbeEstimate& estimate, double truth) {
    const double square = estimate.relative_error * estimate.relative_error;
    const double up = estimate.relative_error + estimate.standard_error;
    return (square - truth * truth) / (up * up - square);
}

TEST(Probes, FindAKnownErrorOfAFurnace) {
    const ProbedWorld probed(furnace(0.5F));
    // The picture should be 2 everywhere. Nothing is a lamp where all shines.
    for (const float error : {-0.2F, 0.05F, 0.5F}) {
        const ProbeEstimate estimate = probed.estimate(uniform(probed.view, 2 * (1 + error)));
        EXPECT_LT(std::abs(score(estimate, std::abs(error))), 3) << error;
        EXPECT_LT(estimate.standard_error, 0.1 * std::abs(error)) << error;
        EXPECT_EQ(estimate.left_out_share, 0);
    }
}

TEST(Probes, FindNoErrorWhereThereIsNone) {
    const ProbedWorld probed(furnace(0.5F));
    const ProbeEstimate estimate = probed.estimate(uniform(probed.view, 2));
    EXPECT_LT(std::abs(score(estimate, 0)), 3);
    EXPECT_LT(estimate.relative_error, 0.02);
    EXPECT_GT(estimate.standard_error, 0) << "no claim to be exact";
}

/// Whether a lamp of radiance 1 shows within one pixel; all else is darker.
bool near_lamp(const Picture& picture, int x, int y) {
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, picture.height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, picture.width - 1); ++u)
            if (max_channel(picture.at(u, v)) > 0.3F) return true;
    return false;
}

TEST(Probes, FindAKnownFaultOnTopOfThePathTracersMean) {
    const ProbedWorld probed(testing::small_room(), 24, 16);
    const PathPicture traced = probed.traced(1024);
    double noise = 0, light = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x) {
            if (near_lamp(traced.mean, x, y)) continue;
            noise += glm::dot(traced.variance.at(x, y), Rgb(1));
            light += glm::dot(traced.mean.at(x, y), traced.mean.at(x, y));
        }
    for (const double fault : {0.0, 0.1, 0.3}) {
        Picture picture = traced.mean;
        // Too bright and too dark in turn: the mean of the picture stays.
        for (std::size_t k = 0; k < picture.pixels.size(); ++k)
            picture.pixels[k] *= static_cast<float>(k % 2 == 0 ? 1 + fault : 1 - fault);
        const ProbeEstimate estimate = probed.estimate(picture);
        EXPECT_LT(std::abs(score(estimate, std::hypot(fault, std::sqrt(noise / light)))), 3) << fault;
        EXPECT_LT(estimate.standard_error, 0.25 * fault + 0.05);
    }
}

TEST(Probes, TheNoiseOfTheirPathsCancels) {
    const ProbedWorld probed(furnace(0.7F), 16, 16);
    const Picture picture = uniform(probed.view, 1.5F / 0.3F);
    ProbeConfig config{64, 2, 2, 1, 1, {}};
    constexpr int seeds = 100;
    double sum = 0, squares = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        config.seed = static_cast<std::uint64_t>(seed);
        const double square = std::pow(probed.estimate(picture, config).relative_error, 2);
        sum += square;
        squares += square * square;
    }
    const double mean = sum / seeds;
    const double standard_error = std::sqrt((squares / seeds - mean * mean) / (seeds - 1));
    // A ratio of means is off by about its variance, the square of a hundredth.
    EXPECT_NEAR(mean, 0.25, 3 * standard_error + 0.002);
    EXPECT_LT(standard_error, 0.01) << "two paths a part spread by a third: uncancelled, that would add 0.05";
}

TEST(Probes, FindFaultsThatFewPixelsHave) {
    const ProbedWorld probed(furnace(0.5F), 128, 128);
    // One pixel in 64 is off by half its light.
    Picture picture = uniform(probed.view, 2);
    for (int y = 4; y < 128; y += 8)
        for (int x = 4; x < 128; x += 8) picture.at(x, y) = Rgb(3);
    ProbeConfig config;
    config.samples_per_part = 4;
    config.paths_per_sample = 1;
    constexpr double truth = 0.5 / 8;
    constexpr int seeds = 30;
    double squares = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        config.seed = static_cast<std::uint64_t>(seed);
        squares += std::pow(probed.estimate(picture, config).relative_error / truth - 1, 2);
    }
    // Half of 128 probes go to the nine pixels around each fault: eight or so meet one, which leaves a spread
    // of 1 / (2 √8). Evenly chosen, two would, and the spread be twice that.
    EXPECT_LT(std::sqrt(squares / seeds), 0.25);
}

TEST(Probes, LeaveOutWhatIsNearALamp) {
    World world = testing::empty_world(0.5F, Vec3(0, 0, 2));
    testing::add_quad(world.bodies[furniture], Vec3(-9, -9, -1), Vec3(18, 0, 0), Vec3(0, 18, 0), 0);
    testing::add_quad(world.bodies[furniture], Vec3(0, -0.5F, 0), Vec3(0.5F, 0, 0), Vec3(0, 0.5F, 0), 1);
    const ProbedWorld probed(std::move(world), 16, 16);
    ASSERT_FALSE(probed.direct->empty());
    // Wrong by far where the lamp is, and nowhere else.
    Picture picture = probed.traced(256).mean;
    const Picture right = picture;
    std::size_t near = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            if (!near_lamp(right, x, y)) continue;
            picture.at(x, y) = Rgb(100);
            ++near;
        }
    ASSERT_GT(near, 8U);
    ProbeConfig config;
    config.pixels = 256;  // all of them
    const ProbeEstimate estimate = probed.estimate(picture, config);
    // A pixel that a lamp covers by less than a third may be missing here.
    EXPECT_GE(estimate.left_out_share, static_cast<double>(near) / 256 - 1e-9);
    EXPECT_LT(estimate.left_out_share, static_cast<double>(near) / 256 + 0.15);
    EXPECT_LT(estimate.relative_error, 0.2);
}

TEST(Probes, AreTheSameForAnyNumberOfThreads) {
    const ProbedWorld probed(testing::small_room());
    const Picture picture = uniform(probed.view, 0.1F);
    const ProbeEstimate one = probed.estimate(picture, {}, Context(1));
    const ProbeEstimate many = probed.estimate(picture, {}, Context(5));
    EXPECT_EQ(one.relative_error, many.relative_error);
    EXPECT_EQ(one.standard_error, many.standard_error);
    EXPECT_EQ(one.left_out_share, many.left_out_share);
    ProbeConfig other;
    other.seed = 2;
    EXPECT_NE(probed.estimate(picture, other).relative_error, one.relative_error);
}

TEST(Probes, SayNothingOfADarkPicture) {
    World world = testing::small_room();
    world.materials[1].emission = Rgb(0);
    const ProbedWorld probed(std::move(world));
    const ProbeEstimate estimate = probed.estimate(uniform(probed.view, 0));
    EXPECT_EQ(estimate.relative_error, 0);
    EXPECT_EQ(estimate.standard_error, 0);
}

TEST(Probes, RefuseWhatCannotBeEstimated) {
    const ProbedWorld probed(testing::small_room());
    const Picture picture = uniform(probed.view, 1);
    for (const ProbeConfig& config : {ProbeConfig{0, 8, 8, 2, 1, {}}, ProbeConfig{256, 1, 8, 2, 1, {}},
                                      ProbeConfig{256, 8, 0, 2, 1, {}}, ProbeConfig{256, 8, 8, 0, 1, {}}})
        EXPECT_THROW(probed.estimate(picture, config), Error);
    EXPECT_THROW(probed.estimate(Picture(4, 4)), Error);
    EXPECT_THROW(probed.estimate(Picture()), Error);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(probed.estimate(picture, {}, Context(2, stop.get_token())), Error);
}

}  // namespace
}  // namespace afterglow
