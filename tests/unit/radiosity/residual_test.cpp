#include "solver/radiosity/residual.h"

#include <random>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "solver/radiosity/progressive.h"
#include "tests/support/actors.h"
#include "tests/support/dense_solve.h"
#include "tests/support/layered_world.h"

namespace afterglow {
namespace {

using testing::LayeredWorld;
using testing::Movements;

/// A world whose light follows its actors.
struct LitLayers {
    LayeredWorld world;
    std::vector<Rgb> emission, reflectance, external;
    ResidualState state;
    Certificate certificate;

    explicit LitLayers(World w, int threads = 2, Index lines = 32) : world(std::move(w), 0.4F, lines) {
        const PatchMesh& mesh = world.lined.mesh;
        for (Index p = 0; p < mesh.size(); ++p) {
            const Material& material = world.lined.world.materials[mesh.material(p)];
            emission.push_back(pi * material.emission);
            reflectance.push_back(material.reflectance);
        }
        external.assign(mesh.size(), Rgb(0));
        world.show_at(0);
        state = make_residual_state(problem(), Context(threads));
    }
    [[nodiscard]] ResidualProblem problem() const {
        return {world.matrix, world.lined.mesh.area_m2, emission, reflectance, external};
    }
    void solve(double asked_error, int threads = 2) {
        ResidualConfig config;
        config.asked_error = asked_error;
        certificate = step(state, problem(), config, Context(threads));
    }
    void move_to(double time_s, double asked_error, int threads = 2) {
        follow(state, problem(), world.show_at(time_s), Context(threads));
        solve(asked_error, threads);
    }
    /// Largest distance to the exact solution of this moment relative to the mean reflected light.
    [[nodiscard]] double actual_error() const {
        const FormFactors compiled = world.compiled();
        const RadiosityProblem all{compiled.matrix, world.lined.mesh.area_m2, emission, reflectance,
                                   external};
        ProgressiveConfig config;
        config.asked_error = 1e-5;
        const auto exact =
            solve_progressive(all, columns_of(compiled.matrix, Context(2)), config, Context(2));
        double error = 0;
        for (std::size_t i = 0; i < emission.size(); ++i)
            error = std::max(
                error, static_cast<double>(max_channel(
                           glm::abs(reflectance[i] * (state.irradiance[i] - exact.state.irradiance[i])))));
        const double mean = mean_reflected(all, exact.state.irradiance);
        return mean > 0 ? error / mean : error;
    }
};

/// A white room nearly filled by a box that moves within it.
World filled_room() {
    World world = testing::small_room();
    for (Material& material : world.materials) material.reflectance = Rgb(0.9F);
    world.bodies.resize(1);
    Body box;
    box.name = "filling";
    testing::add_box(box, Vec3(0.3F, 0.2F, 0.3F), Vec3(3.4F, 2.2F, 3.6F), 0);
    box.path.keys = {{0, {Vec3(0), Quat(1, 0, 0, 0)}}, {1, {Vec3(0.2F, 0.1F, 0.5F), Quat(1, 0, 0, 0)}}};
    world.bodies.push_back(std::move(box));
    return world;
}

TEST(Residual, FindsTheLightFromAnywhereWhereActorsCoverMostLines) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    LitLayers light(filled_room());
    for (const double time : {0.0, 0.6, 1.0}) {
        light.world.show_at(time);
        std::vector<std::optional<Lanes>> known(light.emission.size());
        for (auto& patch : known) patch = to_lanes(Rgb(3 * unit(random), 3 * unit(random), 3 * unit(random)));
        light.state = make_residual_state(light.problem(), known, Context(2));
        // From here on a change is small enough for columns alone.
        ResidualConfig config;
        config.asked_error = 1e-3;
        config.sweep_share = 2;
        light.certificate = step(light.state, light.problem(), config, Context(2));
        EXPECT_EQ(light.state.status, ResidualStatus::converged)
            << light.certificate.error_bound << " after " << light.state.pushes;
        EXPECT_LE(light.actual_error(), light.certificate.error_bound * 1.001 + 2e-5);
    }
}

TEST(Residual, KeepsItsPromiseAtEveryTimeInAnyOrder) {
    for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        LitLayers light(testing::random_world(seed, 4, Movements::turning));
        light.solve(0.01);
        EXPECT_LE(light.actual_error(), light.certificate.error_bound * 1.001 + 2e-5);
        for (const double time : {0.1, 0.2, 0.3, 3.5, 1.0, 0.9, 0.0, 20.0}) {
            const double asked = time < 1 ? 0.01 : 0.0005;
            light.move_to(time, asked);
            EXPECT_EQ(light.state.status, ResidualStatus::converged);
            EXPECT_LE(light.certificate.error_bound, asked);
            // Never more than what the largest reflectance alone allows.
            EXPECT_LE(light.certificate.error_bound,
                      light.certificate.residual / (1 - light.certificate.gain) * 1.000001);
            // The reference itself is good to 1e-5.
            EXPECT_LE(light.actual_error(), light.certificate.error_bound * 1.001 + 2e-5)
                << "seed " << seed << " time " << time;
        }
    }
}

TEST(Residual, ManyFramesLaterItIsNoFartherOff) {
    LitLayers light(testing::random_world(5, 4, Movements::straight));
    light.solve(1e-4);
    for (int lap = 0; lap < 40; ++lap)
        for (const double time : {0.0, 0.5, 1.0, 1.5, 2.0, 1.0}) light.move_to(time, 1e-2);
    light.move_to(0.25, 1e-5);
    EXPECT_LE(light.actual_error(), 4e-5);
}

TEST(Residual, OfRestingActorsCostsNothing) {
    LitLayers light(testing::random_world(6, 4, Movements::turning));
    light.solve(0.01);
    light.move_to(1, 0.01);
    const std::uint64_t pushes = light.state.pushes;
    const std::vector<Rgb> before = light.state.irradiance;
    light.move_to(1, 0.01);
    EXPECT_EQ(light.state.pushes, pushes);
    double largest = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
        largest = std::max(largest,
                           static_cast<double>(max_channel(glm::abs(before[i] - light.state.irradiance[i]))));
    EXPECT_EQ(largest, 0);
}

TEST(Residual, ALampSwitchedOffLeavesTheDarkAndComesBack) {
    LitLayers light(testing::random_world(7, 3, Movements::turning));
    light.solve(1e-4);
    const std::vector<Rgb> lit = light.state.irradiance, emission = light.emission;
    light.emission.assign(emission.size(), Rgb(0));
    light.solve(1e-4);
    // Relative to a mean that is nothing but what is left: only nothing is good enough.
    for (const Rgb& value : light.state.irradiance) EXPECT_LE(max_channel(glm::abs(value)), 1e-6F);
    light.emission = emission;
    light.solve(1e-4);
    EXPECT_LE(light.actual_error(), 1.1e-4);
}

TEST(Residual, ReflectanceGoesToZeroAndReturns) {
    LitLayers light(testing::random_world(8, 3, Movements::turning));
    const std::vector<Rgb> usual = light.reflectance;
    for (const float share : {1.0F, 0.0F, 1.0F, 1.5F, 0.0F, 1.0F}) {
        for (std::size_t i = 0; i < usual.size(); ++i) light.reflectance[i] = share * usual[i];
        light.solve(1e-3);
        EXPECT_LE(light.actual_error(), 1.1e-3) << share;
    }
}

TEST(Residual, AnyDivisionOfThePushesAndAnyThreadsGiveTheSame) {
    const World scene = testing::random_world(9, 4, Movements::turning);
    LitLayers whole(scene);
    whole.solve(1e-3);
    whole.move_to(0.4, 1e-3);
    for (const int threads : {1, 4}) {
        LitLayers parts(scene, threads);
        parts.solve(1e-3, threads);
        follow(parts.state, parts.problem(), parts.world.show_at(0.4, threads), Context(threads));
        ResidualConfig config;
        config.asked_error = 1e-3;
        config.max_pushes = 50;
        int calls = 0;
        do {
            step(parts.state, parts.problem(), config, Context(threads));
            ++calls;
        } while (parts.state.status == ResidualStatus::running);
        EXPECT_GT(calls, 1);
        EXPECT_EQ(parts.state.irradiance, whole.state.irradiance);
    }
}

TEST(Residual, FinerThanSinglePrecisionIsSaidToBeExhausted) {
    LitLayers light(testing::random_world(10, 3, Movements::turning));
    light.solve(1e-12);
    EXPECT_EQ(light.state.status, ResidualStatus::exhausted);
    EXPECT_LE(light.certificate.error_bound, 1e-4);
}

TEST(Residual, WithoutLightThereIsNothingToDo) {
    LitLayers light(testing::random_world(11, 3, Movements::turning));
    light.emission.assign(light.emission.size(), Rgb(0));
    light.state = make_residual_state(light.problem(), Context(1));
    light.solve(0.01);
    EXPECT_EQ(light.state.status, ResidualStatus::converged);
    EXPECT_EQ(light.state.pushes, 0U);
}

TEST(Residual, NamesWhatIsWrong) {
    LitLayers light(testing::random_world(12, 1, Movements::straight));
    const auto place_of = [&](auto&& call) {
        try {
            call();
        } catch (const Error& error) {
            return error.place();
        }
        return std::string("nothing");
    };
    EXPECT_EQ(place_of([&] { light.solve(0); }), "asked error");
    light.reflectance.pop_back();
    EXPECT_EQ(place_of([&] { light.solve(0.1); }), "reflectance");
    light.reflectance.push_back(Rgb(0));
    light.reflectance.front() = Rgb(1.2F);
    EXPECT_EQ(place_of([&] { light.solve(0.1); }), "reflectance");
}

}  // namespace
}  // namespace afterglow
