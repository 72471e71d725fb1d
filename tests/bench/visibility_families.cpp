// Who wins where: each visibility strategy against the number of actors, their faces and their speed, on a
// generated room of furniture with actors on seeded random paths. Sight lines and light lines of static
// patches; the actors' own lines, which all strategies trace alike, are timed apart and taken off. CPU time
// of one thread, all strategies of a scene next to each other. Prints CSV; visibility_families.py draws it.
// Usage: visibility_families [most actors] [most seconds that one strategy may take in a scene]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numeric>
#include <random>

#include "solver/visibility/events.h"
#include "solver/visibility/reach.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

constexpr int frames = 96;
constexpr FrameClock frame_clock{24};
constexpr Index lines_per_patch = 64, light_lines_per_patch = 16;
constexpr float patch_size_m = 0.35F;

double ms_of(const std::function<void()>& work) {
    const std::clock_t start = std::clock();
    work();
    return 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// What a scene of the family is made of.
struct Member {
    int actors;
    int faces;  ///< of an actor: 12 is a box; 320 and 5120 are balls
    const char* speed_name;
    float speed_m_per_s;
};

/// From one random place to the next at one speed, until the last frame.
Path wander(std::mt19937& random, const Box& within, float speed_m_per_s) {
    std::uniform_real_distribution<float> unit(0, 1);
    const auto place = [&] {
        Vec3 at(0);
        for (int k = 0; k < 3; ++k) at[k] = glm::mix(within.low[k], within.high[k], unit(random));
        return at;
    };
    Path path;
    path.keys.push_back({0, {place(), Quat(1, 0, 0, 0)}});
    while (path.keys.back().time_s < frames / frame_clock.frames_per_second) {
        const Vec3 next = place();
        const float way_m = glm::distance(next, path.keys.back().value.translation);
        path.keys.push_back(
            {path.keys.back().time_s + static_cast<double>(way_m / speed_m_per_s), {next, Quat(1, 0, 0, 0)}});
    }
    return path;
}

World furnished_room(const Member& member) {
    World world = testing::empty_world(0.6F, Vec3(4, 1.5F, 6));
    Body& room = world.bodies[furniture];
    testing::add_box(room, Vec3(0), Vec3(8, 3, 6), 0, testing::Facing::inwards);
    testing::add_box(room, Vec3(3, 2.9F, 2.5F), Vec3(5, 2.95F, 3.5F), 1);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int k = 0; k < 16; ++k) {
        const Vec3 at(7 * unit(random), 0.01F, 5 * unit(random));
        testing::add_box(room, at, at + Vec3(0.3F, 0.2F, 0.3F) + Vec3(0.7F, 1.2F, 0.7F) * unit(random), 0);
    }
    Box within;
    within.add(Vec3(0.5F));
    within.add(Vec3(7.5F, 2.3F, 5.5F));
    for (int k = 0; k < member.actors; ++k) {
        Path path = wander(random, within, member.speed_m_per_s);
        if (member.faces == 12) {
            testing::add_actor(world, "actor", Vec3(0.22F), 0, std::move(path));
            continue;
        }
        Body& body = world.bodies.emplace_back();
        body.path = std::move(path);
        testing::add_ball(body, Vec3(0), 0.28F, member.faces == 320 ? 2 : 4, 0);
    }
    return world;
}

/// A scene with its lines and what they see without actors.
struct Scene {
    World world;
    RayCaster caster;
    PatchMesh mesh;
    Lamps lamps;
    SightLines sight;
    LightLines light;
    StaticLines background;
    Context context{1};
    double static_ms;

    explicit Scene(const Member& member)
        : world(furnished_room(member)),
          caster(world),
          mesh(meshed()),
          lamps(find_lamps(world, mesh)),
          sight(mesh, world, lines_per_patch, 1),
          light(mesh, sight, lamps, light_lines_per_patch, 2),
          background(make_static_lines(mesh, sight, light)),
          static_ms(ms_of([&] {
              extend_static_lines(background, mesh, sight, light, caster, lines_per_patch, context);
          })) {}

    PatchMesh meshed() {
        Surfaces surfaces = find_surfaces(world);
        const SideMask reached = reachable_sides(world, surfaces, caster, {}, context);
        return make_patches(world, std::move(surfaces), reached, {.patch_size_m = patch_size_m});
    }
    void stand_at(int frame) { caster.set_poses(poses_at(world, frame_clock.time_of(frame))); }

    /// The actors' own lines in the frame where they stand.
    double own_lines_ms(VisibleLines& visible) {
        return ms_of([&] {
            trace_lines(sight, mesh, caster, Scope::everything,
                        {sight.static_blocks(), sight.blocks().size(), 0, lines_per_patch},
                        {visible.patch, {}}, context);
            trace_moving_light_lines(light, sight, mesh, caster, visible.light_contribution, context);
        });
    }
};

struct Costs {
    double first_ms = 0, frame_ms = 0, all_ms = 0;
    int measured = 0;
};

/// Frames 0, stride, 2·stride … until the time is up; those not measured count as the median.
Costs run(Scene& scene, VisibilityStrategy& strategy, int stride, double own_ms, double most_s) {
    VisibleLines visible = make_visible_lines(scene.mesh, scene.sight, scene.light);
    std::vector<double> frame_ms;
    double spent_ms = 0;
    for (int f = 0; f < frames && spent_ms < 1000 * most_s; f += stride) {
        scene.stand_at(f);
        frame_ms.push_back(ms_of([&] {
                               strategy.update(
                                   {scene.mesh, scene.sight, scene.light, scene.caster, scene.background, f},
                                   {0, lines_per_patch}, visible, scene.context);
                           }) -
                           own_ms);
        spent_ms += frame_ms.back();
    }
    Costs out;
    out.measured = static_cast<int>(frame_ms.size());
    out.first_ms = frame_ms.front();
    out.all_ms = std::accumulate(frame_ms.begin(), frame_ms.end(), 0.0);
    out.frame_ms = median(frame_ms);
    out.all_ms += (frames - out.measured) * out.frame_ms;
    if (strategy.needs_background()) out.all_ms += scene.static_ms;
    return out;
}

void measure(const Member& member, double most_s) {
    Scene scene(member);
    VisibleLines visible = make_visible_lines(scene.mesh, scene.sight, scene.light);
    std::vector<double> own_ms;
    for (int f = 0; f < frames; f += frames / 6) {
        scene.stand_at(f);
        own_ms.push_back(scene.own_lines_ms(visible));
    }
    struct Asked {
        const char* name;
        std::unique_ptr<VisibilityStrategy> strategy;
        int stride;
    };
    Asked asked[] = {{"retrace", make_retrace(), frames / 6},
                     {"back-buffer", make_back_buffer(), frames / 6},
                     {"temporal-graph", make_temporal_graph(scene.world, frame_clock), 1},
                     {"events", make_events(scene.world, frame_clock), 1}};
    for (Asked& each : asked) {
        const Costs costs = run(scene, *each.strategy, each.stride, median(own_ms), most_s);
        std::printf("%d,%d,%s,%s,%u,%.2f,%.2f,%.2f,%.3f,%.1f,%d\n", member.actors, member.faces,
                    member.speed_name, each.name, scene.mesh.static_size(), median(own_ms), scene.static_ms,
                    costs.first_ms, costs.frame_ms, costs.all_ms, costs.measured);
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    using namespace afterglow;
    const int most_actors = count > 1 ? std::atoi(arguments[1]) : 30;
    const double most_s = count > 2 ? std::atof(arguments[2]) : 6;
    std::printf(
        "actors,faces,speed,strategy,static_patches,own_lines_ms,static_ms,first_ms,frame_ms,all_ms,"
        "measured\n");
    for (const int faces : {12, 320, 5120})
        for (const auto& [name, speed] : {std::pair{"slow", 0.3F}, {"normal", 1.2F}, {"fast", 5.0F}})
            for (const int actors : {1, 3, 10, 30})
                if (actors <= most_actors) measure({actors, faces, name, speed}, most_s);
}
