#include "solver/image/kept_picture.h"

#include <cstring>
#include <random>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "tests/support/actors.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::Movements;

constexpr int width = 61, height = 43;  // no multiple of a tile

bool same_bits(const Picture& a, const Picture& b) {
    return a.width == b.width && a.height == b.height &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Rgb)) == 0;
}

/// A world with light that is made up: what pictures are made from, without a solver.
struct Stage {
    testing::LinedWorld lined;
    Interpolation interpolation;
    SmoothNormals normals;
    std::vector<Material> materials;
    std::vector<Rgb> irradiance, emission;
    std::vector<float> confidence;
    std::vector<LightInPlace> lights;
    std::optional<DirectLight> direct;
    std::mt19937 random{7};
    double time_s = 0;

    explicit Stage(World world)
        : lined(std::move(world), 0.5F, 16),
          interpolation(lined.world, lined.mesh),
          normals(lined.world, lined.mesh.surfaces),
          irradiance(lined.mesh.size()),
          emission(lined.mesh.size(), Rgb(0)),
          confidence(lined.mesh.size()) {
        change_light(0, 1, 1);
        move_to(0);
    }

    /// Everything that has a track or a path.
    void move_to(double time) {
        time_s = time;
        lined.caster.set_poses(poses_at(lined.world, time));
        lights = lights_at(lined.world, time);
        materials.clear();
        for (Index m = 0; m < lined.world.materials.size(); ++m)
            materials.push_back(material_at(lined.world, m, time));
        for (Index p = 0; p < lined.mesh.size(); ++p)
            if (is_emitter(lined.world, lined.mesh, p))
                emission[p] = pi * materials[lined.mesh.material(p)].emission;
        direct.emplace(lined.mesh, lined.lamps, lined.caster, emission);
    }
    /// New values for a share of the patches, between `low` and `low` + `range`.
    void change_light(float low, float range, float share) {
        std::uniform_real_distribution<float> unit(0, 1);
        for (std::size_t p = 0; p < irradiance.size(); ++p) {
            if (unit(random) > share) continue;
            irradiance[p] = Rgb(low) + range * Rgb(unit(random), unit(random), unit(random));
            confidence[p] = unit(random);
        }
    }
    [[nodiscard]] LitWorld lit() const {
        LitWorld out;
        out.world = &lined.world;
        out.mesh = &lined.mesh;
        out.interpolation = &interpolation;
        out.normals = &normals;
        out.caster = &lined.caster;
        out.materials = materials;
        out.irradiance = irradiance;
        out.confidence = confidence;
        out.direct = &*direct;
        out.lights = lights;
        out.lift_m = lined.sight.lift_m();
        return out;
    }
    [[nodiscard]] CameraView view() const {
        return view_at(lined.world.cameras.front(), time_s, width, height);
    }
    PictureUpdate update(KeptPictureState& state, const KeptPictureConfig& config,
                         const Context& context = Context(2)) const {
        return step(state, view(), lit(), config, context);
    }
    [[nodiscard]] Picture fresh(const PictureConfig& config) const {
        std::uint64_t rays = 0;
        return render_picture(view(), lit(), config, rays, Context(2));
    }
};

KeptPictureConfig quick() {
    KeptPictureConfig config;
    config.picture = {3, 9, 2, 0.05F, 5};
    return config;
}

void add_lights(World& world) {
    Light light;
    light.intensity = Rgb(1, 2, 3);
    const auto at = [](const Vec3& place) {
        Path path;
        path.keys = {{0, {place, Quat(1, 0, 0, 0)}}};
        return path;
    };
    world.lights.push_back({light, at(Vec3(1, 2.5F, 4))});
    light.kind = Light::Kind::directional;
    world.lights.push_back({light, at(Vec3(0))});
    light.kind = Light::Kind::spot;
    world.lights.push_back({light, at(Vec3(3, 1, 4.5F))});
}

TEST(KeptPicture, IsWhatRenderPictureMakesInAnyOrderOfFrames) {
    for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        World world =
            testing::random_world(seed, 5, seed % 2 == 0 ? Movements::straight : Movements::turning);
        if (seed > 2) add_lights(world);
        Stage stage(std::move(world));
        KeptPictureState state;
        std::uniform_int_distribution<int> any_frame(0, 100);
        std::uint64_t looked_at = 0;
        for (int k = 0; k < 40; ++k) {
            // On, back, and anywhere.
            const int frame = k < 12 ? k : k < 24 ? 24 - k : any_frame(stage.random);
            stage.move_to(frame / 24.0);
            if (k % 3 == 1) stage.change_light(0, 1, 0.02F);
            const PictureUpdate update = stage.update(state, quick());
            EXPECT_EQ(update.anew, k == 0);
            looked_at += update.samples;
            ASSERT_TRUE(same_bits(state.picture, stage.fresh(quick().picture)))
                << "seed " << seed << " frame " << frame << " after " << k;
        }
        EXPECT_GT(looked_at, 0U);
    }
}

TEST(KeptPicture, WhereNothingChangesNothingIsDone) {
    Stage stage(testing::small_room());
    KeptPictureState state;
    stage.update(state, quick());
    const Picture before = state.picture;
    const PictureUpdate update = stage.update(state, quick());
    EXPECT_FALSE(update.anew);
    EXPECT_EQ(update.samples, 0U);
    EXPECT_EQ(update.pixels, 0U);
    EXPECT_EQ(update.rays_traced, 0U);
    EXPECT_TRUE(same_bits(state.picture, before));
}

TEST(KeptPicture, AStepOfAnActorTouchesAPartOfThePicture) {
    Stage stage(testing::small_room());
    KeptPictureState state;
    const std::uint64_t all = stage.update(state, quick()).samples;
    stage.move_to(1 / 24.0);
    const PictureUpdate update = stage.update(state, quick());
    EXPECT_GT(update.samples, 0U);
    EXPECT_LT(update.samples, all / 2);
}

TEST(KeptPicture, ACutOfTheCameraBeginsAnew) {
    World world = testing::random_world(5, 3, Movements::turning);
    Pose& pose = world.cameras.front().path.keys.front().value;
    const Pose first = pose;
    Stage stage(std::move(world));
    Pose& now = stage.lined.world.cameras.front().path.keys.front().value;
    KeptPictureState state;
    for (int k = 0; k < 8; ++k) {
        const bool cut = k % 3 == 0;
        if (cut) now.translation = first.translation + Vec3(0.1F * static_cast<float>(k % 2), 0, 0.01F);
        if (cut) now.translation.y += 0.02F * static_cast<float>(k);
        stage.move_to(0.3 * k);
        EXPECT_EQ(stage.update(state, quick()).anew, cut);
        EXPECT_TRUE(same_bits(state.picture, stage.fresh(quick().picture)));
    }
}

TEST(KeptPicture, OtherMaterialsLightsLampsOrSettingsBeginAnew) {
    World world = testing::small_room();
    add_lights(world);
    Track<float> flicker{1, {{0, 1}, {1, 2}, {2, 2}}};
    world.material_emission.push_back(flicker);
    Track<Rgb> colour{0, {{2, Rgb(0.6F)}, {3, Rgb(0.2F)}, {4, Rgb(0.2F)}}};
    world.material_reflectance.push_back(colour);
    Stage stage(std::move(world));
    KeptPictureState state;
    KeptPictureConfig config = quick();
    const auto begins_anew = [&] {
        const bool anew = stage.update(state, config).anew;
        EXPECT_TRUE(same_bits(state.picture, stage.fresh(config.picture)));
        return anew;
    };
    EXPECT_TRUE(begins_anew());
    for (const double lamp : {0.5, 1.0}) {
        stage.move_to(lamp);
        EXPECT_TRUE(begins_anew());
    }
    stage.move_to(1.5);
    EXPECT_FALSE(begins_anew());
    for (const double reflectance : {2.5, 3.5}) {
        stage.move_to(reflectance);
        EXPECT_TRUE(begins_anew());
    }
    stage.move_to(3.6);
    EXPECT_FALSE(begins_anew());
    stage.lights.front().pose.translation.x += 0.1F;
    EXPECT_TRUE(begins_anew());
    config.picture.noise = 0.5F;
    EXPECT_TRUE(begins_anew());
    config.picture.most_samples_per_pixel = 1;
    EXPECT_TRUE(begins_anew());
    EXPECT_FALSE(begins_anew());
}

TEST(KeptPicture, LightFollowsItsToleranceAndErrorsDoNotCreep) {
    Stage stage(testing::small_room());
    stage.change_light(1, 0.5F, 1);
    KeptPictureConfig config = quick();
    config.tolerance = 0.01F;
    KeptPictureState state;
    stage.update(state, config);
    std::uint64_t lit = 0;
    int untouched = 0;
    for (int k = 0; k < 30; ++k) {
        // Each step alone is within the tolerance; the mean is above 1.
        for (Rgb& value : stage.irradiance) value += 0.003F;
        const PictureUpdate update = stage.update(state, config);
        lit += update.pixels;
        untouched += update.pixels == 0 ? 1 : 0;
        float mean = 0;
        for (const Rgb& value : stage.irradiance) mean = std::max(mean, max_channel(value));
        for (std::size_t p = 0; p < stage.irradiance.size(); ++p)
            EXPECT_LE(max_channel(glm::abs(stage.irradiance[p] - state.irradiance[p])),
                      config.tolerance * mean);
        // The picture is that of the light it says it was made from.
        std::swap(stage.irradiance, state.irradiance);
        EXPECT_TRUE(same_bits(state.picture, stage.fresh(config.picture)));
        std::swap(stage.irradiance, state.irradiance);
    }
    EXPECT_GT(lit, 0U);
    EXPECT_GT(untouched, 10);
}

TEST(KeptPicture, SameBitsForAnyNumberOfThreads) {
    Stage stage(testing::random_world(9, 4, Movements::turning));
    KeptPictureState one, two;
    for (const double time : {0.0, 0.1, 1.7}) {
        stage.move_to(time);
        const PictureUpdate a = stage.update(one, quick(), Context(1));
        const PictureUpdate b = stage.update(two, quick(), Context(4));
        EXPECT_TRUE(same_bits(one.picture, two.picture));
        EXPECT_EQ(a.rays_traced, b.rays_traced);
        EXPECT_EQ(a.samples, b.samples);
    }
}

TEST(KeptPicture, AStopLeavesTheStateUsable) {
    Stage stage(testing::small_room());
    KeptPictureState state;
    stage.update(state, quick());
    stage.move_to(0.5);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(stage.update(state, quick(), Context(2, stop.get_token())), Error);
    EXPECT_TRUE(stage.update(state, quick()).anew);
    EXPECT_TRUE(same_bits(state.picture, stage.fresh(quick().picture)));
}

TEST(KeptPicture, WhatTakesTooMuchMemoryIsNotKept) {
    Stage stage(testing::small_room());
    KeptPictureState state;
    KeptPictureConfig config = quick();
    config.most_bytes = 1000;
    for (const double time : {0.0, 0.5}) {
        stage.move_to(time);
        EXPECT_TRUE(stage.update(state, config).anew);
        EXPECT_TRUE(state.tiles.empty());
        EXPECT_TRUE(same_bits(state.picture, stage.fresh(config.picture)));
    }
}

}  // namespace
}  // namespace afterglow
