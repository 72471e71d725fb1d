// Who wins where: each visibility strategy against the number of actors, their faces and their speed, on a
// generated room of furniture with actors on seeded random paths. Sight lines of static patches only, which
// is where the strategies differ. CPU time of one thread, all strategies of a scene next to each other.
// Prints CSV; visibility_families.py draws it. Usage: visibility_families [most actors]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numeric>
#include <optional>
#include <random>

#include "solver/visibility/events.h"
#include "solver/visibility/line_events.h"
#include "solver/visibility/own_lines.h"
#include "solver/visibility/reach.h"
#include "tests/bench/timing.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

constexpr int frames = 96;
constexpr FrameClock frame_clock{24};
constexpr Index lines_per_patch = 64;
constexpr float patch_size_m = 0.35F;

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
    Context context{1};
    World world;
    RayCaster caster;
    PatchMesh mesh;
    Lamps no_lamps;
    SightLines sight;
    LightLines no_light;
    StaticLines background;
    double static_ms;
    VisibleLines visible;

    explicit Scene(const Member& member)
        : world(furnished_room(member)),
          caster(world),
          mesh(meshed()),
          no_lamps{{}, std::vector<Index>(mesh.size(), no_index), {}, {}},
          sight(mesh, world, lines_per_patch, 1),
          no_light(mesh, sight, no_lamps, 1, 2),
          background(make_static_lines(mesh, sight, no_light)),
          static_ms(ms_of([&] {
              extend_static_lines(background, mesh, sight, no_light, caster, lines_per_patch, context);
          })),
          visible(make_visible_lines(mesh, sight, no_light)) {}

    PatchMesh meshed() {
        Surfaces surfaces = find_surfaces(world, {.facet_size_m = patch_size_m});
        const SideMask reached = reachable_sides(world, surfaces, caster, {}, context);
        return make_patches(world, std::move(surfaces), reached, {.patch_size_m = patch_size_m});
    }
    void stand_at(int frame) { caster.set_poses(poses_at(world, frame_clock.time_of(frame))); }
    void trace(std::size_t first_block, std::size_t last_block) {
        trace_lines(sight, mesh, caster, Scope::everything, {first_block, last_block, 0, lines_per_patch},
                    {visible.patch, {}}, context);
    }
};

void retrace(Scene& scene, int) {
    scene.trace(0, scene.sight.static_blocks());
}

/// What `events` does about static patches' sight lines.
class Events {
  public:
    explicit Events(const Scene& scene) : trees_(make_actor_trees(scene.world)) {}

    void operator()(Scene& scene, int frame) {
        if (!window_ || !window_->contains(frame)) {
            window_ = event_window(frame, 0, {});
            const SweptActors actors(scene.world, trees_, frame_clock, *window_);
            const EventScene in{scene.world,      scene.mesh, scene.sight, scene.no_light,
                                scene.background, actors,     scene.caster};
            events_ = find_line_events(in, {0, lines_per_patch}, {}, scene.context);
            std::copy(scene.background.background.patch.begin(), scene.background.background.patch.end(),
                      scene.visible.patch.begin());
        }
        for (const LineEvent& event : events_.at(frame - window_->first))
            scene.visible.patch[event.line] = event.to;
    }

  private:
    ActorTrees trees_;
    std::optional<FrameSpan> window_;
    LineEvents events_;
};

struct Costs {
    std::vector<double> frame_ms = {};
    /// Of all frames; those not measured count as the median of those that are.
    [[nodiscard]] double all_ms() const {
        return std::accumulate(frame_ms.begin(), frame_ms.end(), 0.0) +
               static_cast<double>(frames - static_cast<int>(frame_ms.size())) * median(frame_ms);
    }
};

template <class Work>
Costs run(Scene& scene, int frames_measured, int stride, Work work) {
    Costs costs;
    for (int k = 0; k < frames_measured; ++k) {
        scene.stand_at(k * stride);
        costs.frame_ms.push_back(ms_of([&] { work(scene, k * stride); }));
    }
    return costs;
}

/// A strategy's updates, and the actors' own lines that it looks along as well taken off.
Costs run_strategy(Scene& scene, VisibilityStrategy& strategy, int frames_measured, int stride) {
    const auto lines = [](const Scene& in, int frame) {
        return LineScene{in.mesh, in.sight, in.no_light, in.caster, in.background, frame};
    };
    Costs costs = run(scene, frames_measured, stride, [&](Scene& in, int frame) {
        strategy.update(lines(in, frame), {0, lines_per_patch}, in.visible, in.context);
    });
    OwnLines own_lines(scene.world);
    const Costs own = run(scene, frames_measured, stride, [&](Scene& in, int frame) {
        own_lines.update(lines(in, frame), {0, lines_per_patch}, in.visible, in.context);
    });
    for (std::size_t k = 0; k < costs.frame_ms.size(); ++k) costs.frame_ms[k] -= own.frame_ms[k];
    return costs;
}

void print(const Scene& scene, const Member& member, const char* strategy, const Costs& costs,
           double static_ms) {
    std::printf("%d,%d,%s,%s,%u,%.1f,%.2f,%.3f,%.1f\n", member.actors, member.faces, member.speed_name,
                strategy, scene.mesh.static_size(), static_ms, costs.frame_ms.front(), median(costs.frame_ms),
                static_ms + costs.all_ms());
    std::fflush(stdout);
}

void measure(const Member& member) {
    Scene scene(member);
    print(scene, member, "retrace", run(scene, 6, frames / 6, retrace), 0);
    print(scene, member, "back-buffer",
          run_strategy(scene, *make_back_buffer(scene.world, frame_clock), 6, frames / 6), scene.static_ms);
    print(scene, member, "temporal-graph",
          run_strategy(scene, *make_temporal_graph(scene.world, frame_clock), 16, 1), scene.static_ms);
    print(scene, member, "events", run(scene, frames, 1, Events(scene)), scene.static_ms);
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    using namespace afterglow;
    const int most_actors = count > 1 ? std::atoi(arguments[1]) : 30;
    std::printf("actors,faces,speed,strategy,static_patches,static_ms,first_ms,frame_ms,all_ms\n");
    for (const int faces : {12, 320, 5120})
        for (const auto& [name, speed] : {std::pair{"slow", 0.3F}, {"normal", 1.2F}, {"fast", 5.0F}})
            for (const int actors : {1, 3, 10, 30})
                if (actors <= most_actors) measure({actors, faces, name, speed});
}
