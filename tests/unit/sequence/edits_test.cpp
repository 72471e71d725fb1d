#include "solver/sequence/edits.h"

#include <functional>
#include <random>
#include <stop_token>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "tests/support/worlds.h"
#include "tests/unit/sequence/quick_sequences.h"

namespace afterglow {
namespace {

/// The small room with a box on its floor that may be given another material, and made to shine.
World room_with_box() {
    World world = testing::small_room();
    world.materials.push_back(testing::diffuse("box", Rgb(0.3F)));
    testing::add_box(world.bodies[furniture], Vec3(2.8F, 0, 0.6F), Vec3(3.2F, 0.4F, 1.0F), 2);
    return world;
}

/// The same with three lamps without surface: a bulb, and one spot in two places.
World room_with_lamps() {
    World world = room_with_box();
    const auto add_lamp = [&](const std::string& name, Light::Kind kind, const Vec3& place) {
        PlacedLight& lamp = world.lights.emplace_back();
        lamp.light.name = name;
        lamp.light.kind = kind;
        lamp.light.intensity = Rgb(2, 1.5F, 1);
        const Quat downwards = glm::angleAxis(-pi / 2, Vec3(1, 0, 0));
        lamp.path.keys = {{0, {place, downwards}}};
    };
    add_lamp("bulb", Light::Kind::point, Vec3(1, 2.2F, 1));
    add_lamp("spot", Light::Kind::spot, Vec3(3, 2.5F, 1));
    add_lamp("spot", Light::Kind::spot, Vec3(3, 2.5F, 4));
    return world;
}

SequenceConfig fine() {
    SequenceConfig config;
    config.visibility = Visibility::events;
    config.solution = Solution::residual;
    config.patch_size_m = 0.4;
    config.rays_per_patch = 32;
    config.asked_error = 1e-3;
    config.quality = Quality::draft;
    config.width = 48;
    config.height = 32;
    // Automatic exposure would be that of the scene before its edits.
    config.exposure_ev = 0;
    return config;
}

/// Largest difference relative to the mean.
double difference(const Picture& a, const Picture& b) {
    double largest = 0, sum = 0;
    for (std::size_t k = 0; k < a.pixels.size(); ++k) {
        largest = std::max(largest, static_cast<double>(max_channel(glm::abs(a.pixels[k] - b.pixels[k]))));
        sum += static_cast<double>(max_channel(b.pixels[k]));
    }
    return largest * static_cast<double>(b.pixels.size()) / sum;
}

/// The edited job's frame against that of a new job on the edited scene.
void expect_as_new(SequenceState& edited, World scene, int frame) {
    SequenceState fresh = make_state(std::move(scene), fine(), Context(2));
    // A job that was meshed for light in more places has other blocks of patches, whose lines go other ways.
    const bool same_patches = edited.statistics().patches == fresh.statistics().patches;
    EXPECT_GE(edited.statistics().patches, fresh.statistics().patches);
    EXPECT_LE(difference(testing::picture_of(edited, frame), testing::picture_of(fresh, frame)),
              same_patches ? 4e-3 : 4e-2)
        << "frame " << frame;
}

struct Edited {
    World scene;
    SequenceState state;

    explicit Edited(World world = room_with_box())
        : scene(std::move(world)), state(make_state(scene, fine(), Context(2))) {
        for (const int frame : {0, 1, 2}) testing::picture_of(state, frame);
    }
    void expect_as_new(int frame) { afterglow::expect_as_new(state, scene, frame); }
};

TEST(Edits, TheNextFrameShowsAPictureBeforeItsFinalOne) {
    Edited job;
    const auto pictures = [&](int frame) {
        int count = 0;
        step(
            job.state, frame, [&](const Revision&) { ++count; }, Context(2));
        return count;
    };
    EXPECT_EQ(pictures(3), 1) << "what follows is quick";
    set_emission(job.state, job.scene.materials[1].name, Rgb(0.5F), Context(2));
    EXPECT_EQ(pictures(4), 2);
    EXPECT_EQ(pictures(5), 1);
    set_emission(job.state, "box", Rgb(3, 2, 1), Context(2));
    EXPECT_GE(pictures(4), 3) << "light that begins anew comes coarse first";
}

TEST(Edits, AReflectanceChangesWithoutTracingALine) {
    Edited job;
    const EditOutcome outcome = set_reflectance(job.state, "box", Rgb(0.7F, 0.1F, 0.0F));
    EXPECT_EQ(outcome.lines_reused, 1);
    EXPECT_TRUE(outcome.light_reused);
    job.scene.materials[2].reflectance = Rgb(0.7F, 0.1F, 0.0F);
    job.expect_as_new(3);
    set_reflectance(job.state, "box", Rgb(0.3F));
    job.scene.materials[2].reflectance = Rgb(0.3F);
    job.expect_as_new(4);
}

TEST(Edits, ALampIsDimmedPutOutAndLitAgain) {
    Edited job;
    for (const float emission : {0.3F, 0.0F, 2.0F}) {
        const EditOutcome outcome =
            set_emission(job.state, job.scene.materials[1].name, Rgb(emission), Context(2));
        EXPECT_EQ(outcome.lines_reused, 1);
        if (emission == 0) {
            for (const Rgb& pixel : testing::picture_of(job.state, 3).pixels)
                ASSERT_LE(max_channel(pixel), 1e-6F);
            continue;
        }
        job.scene.materials[1].emission = Rgb(emission);
        job.expect_as_new(3);
    }
}

/// Makes an edit of jobs of its own, stopped at each of its first reports in turn and, once, before all of
/// them, and looks at what each is then.
void expect_stops_change_nothing(const std::function<void(Edited&, const Context&)>& edit) {
    int stopped = 0;
    for (int reports_seen = 0; reports_seen < 4; ++reports_seen) {
        Edited job;
        const std::size_t patches = job.state.statistics().patches;
        std::stop_source stop;
        int reports = 0;
        const auto sink = [&](const Progress&) {
            if (++reports >= reports_seen) stop.request_stop();
        };
        if (reports_seen == 0) stop.request_stop();
        try {
            edit(job, Context(2, stop.get_token(), sink));
            continue;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::cancelled);
        }
        ++stopped;
        job.expect_as_new(3);
        EXPECT_EQ(job.state.statistics().patches, patches);
        // It can still be done.
        edit(job, Context(2));
    }
    EXPECT_GT(stopped, 0);
}

TEST(Edits, AStopWhileLampsAreFoundLeavesThemAsTheyWere) {
    expect_stops_change_nothing(
        [](Edited& job, const Context& context) { set_emission(job.state, "box", Rgb(3, 2, 1), context); });
}

TEST(Edits, AStopLeavesAnActorOnItsPath) {
    expect_stops_change_nothing([](Edited& job, const Context& context) {
        const Body& actor = job.scene.bodies[1];
        const Path still{{{0.0, actor.path.keys.front().value}}};
        set_path(job.state, actor.name, 0.1, still, context);
    });
}

TEST(Edits, LampsWithoutSurfaceAreDimmedPutOutAndLitAgain) {
    Edited job(room_with_lamps());
    for (const float intensity : {0.2F, 0.0F, 5.0F}) {
        const Rgb warm = intensity * Rgb(1, 0.8F, 0.5F);
        const EditOutcome outcome = set_intensity(job.state, "spot", warm);
        EXPECT_EQ(outcome.lines_reused, 1);
        EXPECT_TRUE(outcome.light_reused);
        for (const Index spot : {1, 2}) job.scene.lights[spot].light.intensity = warm;
        job.expect_as_new(3);
    }
    set_intensity(job.state, "bulb", Rgb(0));
    job.scene.lights[0].light.intensity = Rgb(0);
    job.expect_as_new(12);
}

TEST(Edits, ALampsLightFollowsByEveryMethod) {
    World scene = room_with_lamps();
    for (const Solution solution : {Solution::progressive, Solution::incremental, Solution::active_passive,
                                    Solution::residual, Solution::in_view}) {
        SequenceConfig config = fine();
        config.solution = solution;
        SequenceState edited = make_state(scene, config, Context(2));
        testing::picture_of(edited, 0);
        set_intensity(edited, "bulb", Rgb(0.5F, 3, 6));
        World changed = scene;
        changed.lights[0].light.intensity = Rgb(0.5F, 3, 6);
        SequenceState fresh = make_state(changed, config, Context(2));
        EXPECT_LE(difference(testing::picture_of(edited, 0), testing::picture_of(fresh, 0)), 4e-3)
            << "solution " << static_cast<int>(solution);
    }
}

TEST(Edits, SomethingElseBeginsToShine) {
    Edited job;
    const EditOutcome outcome = set_emission(job.state, "box", Rgb(3, 2, 1), Context(2));
    EXPECT_LT(outcome.lines_reused, 1);
    EXPECT_FALSE(outcome.light_reused);
    job.scene.materials[2].emission = Rgb(3, 2, 1);
    job.expect_as_new(3);
    job.expect_as_new(12);
}

TEST(Edits, AnActorTakesAnotherWayFromATimeOn) {
    Edited job;
    Path path;
    path.keys = {{0, {Vec3(1, 1, 1), Quat(1, 0, 0, 0)}}, {1, {Vec3(3, 1.5F, 3), Quat(1, 0, 0, 0)}}};
    const std::string actor = job.scene.bodies[1].name;
    const Path before = job.scene.bodies[1].path;
    set_path(job.state, actor, 0.25, path, Context(2));
    // Up to then nothing changed, from then on it is the new way, with a jump between.
    job.expect_as_new(2);
    EXPECT_EQ(before.at(0.1), job.scene.bodies[1].path.at(0.1));
    job.scene.bodies[1].path = path;
    job.expect_as_new(6);
    job.expect_as_new(20);
}

TEST(Edits, AnotherWayThroughTheSameSpaceKeepsTheFurnituresLines) {
    Edited job;
    Path path = job.scene.bodies[1].path;
    path.keys[1].value.translation.y = 1.1F;
    const EditOutcome outcome = set_path(job.state, job.scene.bodies[1].name, 0, path, Context(2));
    EXPECT_EQ(outcome.lines_reused, 1);
    EXPECT_GT(outcome.ahead_reused, 0.4);
    EXPECT_LT(outcome.ahead_reused, 1);
    job.scene.bodies[1].path = path;
    job.expect_as_new(15);
    job.expect_as_new(4);
}

TEST(Edits, TheCameraMovesAndTheLightStays) {
    Edited job;
    PlacedCamera camera = job.scene.cameras[0];
    camera.path.keys = {{0, {Vec3(1, 2, 4.5F), Quat(1, 0, 0, 0)}}};
    set_camera(job.state, camera);
    job.scene.cameras[0] = camera;
    job.expect_as_new(3);
}

TEST(Edits, AnyOrderOfThemEndsWhereANewJobStarts) {
    std::mt19937 random(5);
    Edited job;
    for (int round = 0; round < 12; ++round) {
        const auto value = [&] { return 0.1F * static_cast<float>(random() % 9); };
        switch (random() % 4) {
            case 0:
                job.scene.materials[2].reflectance = Rgb(value(), value(), value());
                set_reflectance(job.state, "box", job.scene.materials[2].reflectance);
                break;
            case 1:
                job.scene.materials[1].emission = Rgb(0.5F + value());
                set_emission(job.state, job.scene.materials[1].name, job.scene.materials[1].emission,
                             Context(2));
                break;
            case 2:
                job.scene.bodies[1].path.keys = {
                    {0, {Vec3(0.5F + 3 * value(), 1, 0.5F + 4 * value()), Quat(1, 0, 0, 0)}},
                    {1, {Vec3(0.5F + 3 * value(), 1, 0.5F + 4 * value()), Quat(1, 0, 0, 0)}}};
                set_path(job.state, job.scene.bodies[1].name, 0, job.scene.bodies[1].path, Context(2));
                break;
            default:
                break;
        }
        const int frame = static_cast<int>(random() % 30);
        if (round % 3 == 2)
            job.expect_as_new(frame);
        else
            testing::picture_of(job.state, frame);
    }
}

TEST(Edits, AnyOrderOfThemAmongLampsEndsWhereANewJobStarts) {
    std::mt19937 random(11);
    Edited job(room_with_lamps());
    for (int round = 0; round < 9; ++round) {
        const auto value = [&] { return 0.5F * static_cast<float>(random() % 9); };
        const Rgb light(value(), value(), value());
        switch (random() % 3) {
            case 0:
                set_intensity(job.state, "bulb", light);
                job.scene.lights[0].light.intensity = light;
                break;
            case 1:
                set_intensity(job.state, "spot", light);
                for (const Index spot : {1, 2}) job.scene.lights[spot].light.intensity = light;
                break;
            default:
                set_emission(job.state, job.scene.materials[1].name, Rgb(0.1F) + light, Context(2));
                job.scene.materials[1].emission = Rgb(0.1F) + light;
                break;
        }
        const int frame = static_cast<int>(random() % 30);
        if (round % 3 == 2)
            job.expect_as_new(frame);
        else
            testing::picture_of(job.state, frame);
    }
}

TEST(Edits, BadOnesAreNamedAndChangeNothing) {
    Edited job;
    const auto place_of = [](auto&& edit) {
        try {
            edit();
        } catch (const Error& error) {
            return error.place();
        }
        return std::string("nothing");
    };
    EXPECT_EQ(place_of([&] { set_reflectance(job.state, "no such", Rgb(0)); }), "material");
    EXPECT_EQ(place_of([&] { set_reflectance(job.state, "box", Rgb(1)); }), "reflectance");
    EXPECT_EQ(place_of([&] { set_emission(job.state, "box", Rgb(-1), Context(1)); }), "emission");
    EXPECT_EQ(place_of([&] { set_intensity(job.state, "box", Rgb(1)); }), "lamp");
    EXPECT_EQ(place_of([&] { set_path(job.state, "furniture", 0, Path(), Context(1)); }), "actor");
    const std::string actor = job.scene.bodies[1].name;
    EXPECT_EQ(place_of([&] { set_path(job.state, actor, 0, Path(), Context(1)); }), "path");
    Path path;
    path.keys = {{0, {Vec3(0), Quat(2, 0, 0, 0)}}};
    EXPECT_EQ(place_of([&] { set_path(job.state, actor, 0, path, Context(1)); }), "path key 0");
    path.keys = {{1, {}}, {0, {}}};
    EXPECT_EQ(place_of([&] { set_path(job.state, actor, 0, path, Context(1)); }), "path key 1");
    EXPECT_EQ(place_of([&] { set_camera(job.state, PlacedCamera()); }), "camera");
    job.expect_as_new(3);
}

}  // namespace
}  // namespace afterglow
