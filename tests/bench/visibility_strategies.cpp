// What each visibility strategy costs on the living room: static pass, work ahead, then frame by frame; all
// in one run, as CPU time. Prints tables. Usage: visibility_strategies [frames per second] [patch size, m]
// [lines a patch] [threads] [frames]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numeric>

#include "solver/scene/load.h"
#include "solver/visibility/events.h"
#include "solver/visibility/line_events.h"
#include "solver/visibility/own_light_lines.h"
#include "solver/visibility/own_lines.h"
#include "solver/visibility/packet_hull.h"
#include "tests/bench/room.h"
#include "tests/bench/timing.h"

namespace afterglow {
namespace {

constexpr int window = 128;

std::size_t static_lines(const LinedRoom& room) {
    return std::size_t{room.mesh.static_size()} * room.sight.lines_per_patch();
}

struct Row {
    const char* name;
    double ahead_ms = 0;
    std::vector<double> frame_ms = {};
};

/// Bytes, per line that changes at some time, of what lines see and of events.
void print_bytes(std::size_t lines, std::size_t lines_that_change, std::size_t events) {
    // Background patch and distance, and the patch that is seen now.
    constexpr double per_line = 2 * sizeof(Index) + sizeof(float), per_event = sizeof(LineEvent);
    const auto changing = static_cast<double>(lines_that_change);
    std::printf(
        "bytes a line %.0f, an event %.0f; a line that changes %.1f with its %.2f events, with all other "
        "lines %.1f\n",
        per_line, per_event, per_line + per_event * static_cast<double>(events) / changing,
        static_cast<double>(events) / changing,
        (per_line * static_cast<double>(lines) + per_event * static_cast<double>(events)) / changing);
}

/// Which packets of a window any actor's swept box may be met by, alone: the candidates.
void time_candidates(const LinedRoom& room, const FrameClock& clock, int frames, double static_ms) {
    const int last = std::min(frames, window) - 1;
    std::vector<Box> swept(room.world.bodies.size());
    for (Index b = 1; b < swept.size(); ++b)
        for (int f = 0; f <= last; ++f) {
            const Pose pose = room.world.bodies[b].path.at(clock.time_of(f));
            for (const Vec3& position : room.world.bodies[b].positions) swept[b].add(pose.point(position));
        }
    Box all;
    for (const Box& box : swept) all.add(box);
    const float reach_m = glm::length(glm::max(glm::abs(all.low), glm::abs(all.high)));
    std::size_t candidates = 0, packets = 0;
    const double ms = ms_of([&] {
        RayPacket rays;
        for (std::size_t b = 0; b < room.sight.static_blocks(); ++b)
            for (Index d = 0; d < room.sight.lines_per_patch(); ++d) {
                room.sight.rays(b, d, Pose{}, rays);
                const PatchBlock& block = room.sight.blocks()[b];
                std::copy_n(room.background.background.distance.begin() +
                                static_cast<std::ptrdiff_t>(room.sight.line(block, d, 0)),
                            block.count, rays.far.begin());
                const PacketHull hull(rays, reach_m);
                ++packets;
                candidates += std::any_of(swept.begin() + 1, swept.end(),
                                          [&](const Box& box) { return hull.may_meet(box); })
                                  ? 1U
                                  : 0U;
            }
    });
    std::printf("candidates of %d frames: %.1f %% of %zu packets, %.1f ms, %.2f of the static pass\n",
                last + 1, 100.0 * static_cast<double>(candidates) / static_cast<double>(packets), packets, ms,
                ms / static_ms);
}

/// Sight lines of static patches only, which is where the strategies differ.
void compare_static_lines(LinedRoom& room, const FrameClock& clock, int frames, const Context& context) {
    const Index lines = room.sight.lines_per_patch();
    Row retrace{"retrace"}, events{"events"};
    const double static_ms = ms_of([&] {
        extend_static_lines(room.background, room.mesh, room.sight, room.light, room.caster, lines, context);
    });
    std::vector<Index> anew(std::size_t{room.mesh.size()} * lines), shown(anew), before;
    const ActorTrees trees = make_actor_trees(room.world);
    std::uint64_t changes = 0, k = 0, events_applied = 0, different = 0, lines_that_change = 0,
                  all_events = 0;
    std::vector<char> cut(static_lines(room), 0);
    LineEvents found;
    for (int f = 0; f < frames; ++f) {
        if (f % window == 0) {
            events.ahead_ms += ms_of([&] {
                const SweptActors actors(room.world, trees, clock, {f, f + window - 1});
                const EventScene scene{room.world,      room.mesh, room.sight, room.light,
                                       room.background, actors,    room.caster};
                found = find_line_events(scene, {0, lines}, {}, context);
            });
            std::copy(room.background.background.patch.begin(), room.background.background.patch.end(),
                      shown.begin());
            for (const LineEvent& event : found.list) cut[event.line] = 1;
            all_events += found.list.size();
        }
        events.frame_ms.push_back(ms_of([&] {
            for (const LineEvent& event : found.at(f % window)) shown[event.line] = event.to;
        }));
        if (f % window > 0) events_applied += found.at(f % window).size();
        // The others are too slow to run at each of many frames.
        const bool sampled = f % std::max(1, frames / 24) == 1;
        if (!sampled) {
            before = {};
            if ((f + 1) % std::max(1, frames / 24) != 1) continue;
        }
        room.caster.set_poses(poses_at(room.world, clock.time_of(f)));
        const double retrace_ms = ms_of([&] {
            trace_lines(room.sight, room.mesh, room.caster, Scope::everything,
                        {0, room.sight.static_blocks(), 0, lines}, {anew, {}}, context);
        });
        if (!sampled) {
            before = anew;
            continue;
        }
        retrace.frame_ms.push_back(retrace_ms);
        for (std::size_t line = 0; line < static_lines(room); ++line) {
            changes += anew[line] != before[line] ? 1U : 0U;
            different += anew[line] != shown[line] ? 1U : 0U;
        }
        if (f % window > 0) {
            k += found.at(f % window).size();
        }
    }
    lines_that_change = static_cast<std::uint64_t>(std::count(cut.begin(), cut.end(), 1));
    const double per_frame = median(retrace.frame_ms);
    std::printf("static pass %.0f ms; %zu lines of static patches, %.1f %% change at some time\n", static_ms,
                static_lines(room),
                100.0 * static_cast<double>(lines_that_change) / static_cast<double>(static_lines(room)));
    std::printf(
        "at %zu sampled frames: %llu changes by retracing, %llu by events; %llu of the lines differ\n",
        retrace.frame_ms.size(), static_cast<unsigned long long>(changes), static_cast<unsigned long long>(k),
        static_cast<unsigned long long>(different));
    std::printf("%-14s %12s %12s %10s %14s\n", "strategy", "ahead, ms", "frame, ms", "ratio", "whole, ratio");
    for (const Row* row : {&retrace, &events}) {
        const double frame_ms = median(row->frame_ms);
        const double fixed = row == &retrace ? 0 : static_ms + row->ahead_ms;
        std::printf("%-14s %12.1f %12.3f %10.1f %14.1f\n", row->name, row->ahead_ms, frame_ms,
                    per_frame / frame_ms, per_frame * frames / (fixed + frame_ms * frames));
    }
    std::printf("events in all: %.2f M\n", static_cast<double>(events_applied) * 1e-6);
    std::printf(
        "a frame touches %.3f k lines where k see another patch; cheaper than retracing from frame %.0f on\n",
        static_cast<double>(k) / static_cast<double>(std::max<std::uint64_t>(changes, 1)),
        std::ceil((static_ms + events.ahead_ms) / (per_frame - median(events.frame_ms))));
    print_bytes(static_lines(room), lines_that_change, all_events);
    time_candidates(room, clock, frames, static_ms);
}

/// What is looked ahead along light lines, a window at a time.
void time_light_lines(const LinedRoom& room, const FrameClock& clock, int frames, const Context& context) {
    const ActorTrees trees = make_actor_trees(room.world);
    std::size_t events = 0;
    const double ahead_ms = ms_of([&] {
        for (int f = 0; f < frames; f += window) {
            const SweptActors actors(room.world, trees, clock, {f, f + window - 1});
            const EventScene scene{room.world,      room.mesh, room.sight, room.light,
                                   room.background, actors,    room.caster};
            events += find_light_events(scene, {}, context).list.size();
        }
    });
    std::printf("\n%zu light lines of static patches: ahead %.1f ms, %.2f M events\n",
                std::size_t{room.mesh.static_size()} * room.light.lines_per_patch(), ahead_ms,
                static_cast<double>(events) * 1e-6);
}

/// Actors' own lines, of which some or all differ, and their light lines: all anew, or as OwnLines and
/// OwnLightLines do it. Medians over sampled frames and exact counts of rays.
void compare_own_lines(LinedRoom& room, const FrameClock& clock, int frames, const Context& context) {
    std::printf("\nactors' own lines        rays a frame, anew  frame, ms  kept, rays  frame, ms  ratio\n");
    const auto print = [](const char* name, double anew_rays, const std::vector<double>& anew_ms,
                          double kept_rays, const std::vector<double>& kept_ms) {
        std::printf("%-24s %18.0f %10.2f %11.0f %10.2f %6.1f\n", name, anew_rays, median(anew_ms), kept_rays,
                    median(kept_ms), median(anew_ms) / median(kept_ms));
    };
    VisibleLines seen = make_visible_lines(room.mesh, room.sight, room.light);
    const Index lines = room.sight.lines_per_patch();
    std::vector<int> sampled;
    for (int f = 0; f < frames; f += std::max(1, frames / 24)) sampled.push_back(f);
    const double shots = static_cast<double>(sampled.size());
    for (const Index repeats : {1U, 2U, 4U, 8U}) {
        const SightLines sight(room.mesh, room.world, lines, 1, {repeats, 1});
        OwnLines own(room.world);
        std::vector<double> anew_ms, kept_ms;
        double anew_rays = 0, kept_rays = 0;
        for (const int f : sampled) {
            room.caster.set_poses(poses_at(room.world, clock.time_of(f)));
            const LineScene scene{room.mesh, sight, room.light, room.caster, room.background, f};
            anew_ms.push_back(ms_of([&] {
                anew_rays += static_cast<double>(trace_lines(
                    sight, room.mesh, room.caster, Scope::everything,
                    {sight.static_blocks(), sight.blocks().size(), 0, lines}, {seen.patch, {}}, context));
            }));
            kept_ms.push_back(ms_of([&] {
                const auto rays = own.update(scene, {0, lines}, seen, context);
                kept_rays += f == sampled.front() ? 0.0 : static_cast<double>(rays);
            }));
        }
        print(("1 line in " + std::to_string(repeats)).c_str(), anew_rays / shots, anew_ms,
              kept_rays / (shots - 1), kept_ms);
    }
    // Their own light lines, of which one in so many differs.
    for (const Index repeats : {1U, 2U, 4U}) {
        const LightLines light(room.mesh, room.sight, room.lamps, room.light.lines_per_patch(), 2,
                               {repeats, 1});
        OwnLightLines own(room.world);
        std::vector<double> kept_ms;
        double rays = 0;
        for (const int f : sampled) {
            room.caster.set_poses(poses_at(room.world, clock.time_of(f)));
            const LineScene scene{room.mesh, room.sight, light, room.caster, room.background, f};
            kept_ms.push_back(ms_of([&] { rays += static_cast<double>(own.update(scene, seen, context)); }));
        }
        std::printf("light lines, 1 in %u %47.0f %10.2f\n", repeats, rays / shots, median(kept_ms));
    }
}

/// Everything a frame looks along: actors' own lines and light lines, too.
void compare_whole_frames(LinedRoom& room, const FrameClock& clock, int frames, const Context& context) {
    struct Asked {
        const char* name;
        std::unique_ptr<VisibilityStrategy> strategy;
        bool every_frame;
    };
    Asked asked[] = {{"retrace", make_retrace(), false},
                     {"back-buffer", make_back_buffer(room.world, clock), false},
                     {"temporal-graph", make_temporal_graph(room.world, clock), true},
                     {"events, 128", make_events(room.world, clock, {window, window}), true},
                     {"events", make_events(room.world, clock), true}};
    std::printf("\nwith light lines and actors' own lines (%.1f %% of the patches)\n",
                100.0 - 100.0 * room.mesh.static_size() / room.mesh.size());
    std::printf("%-14s %15s %12s %15s %10s\n", "strategy", "first frame, ms", "frame, ms", "all frames, ms",
                "ratio");
    double retraced_ms = 0;
    for (Asked& each : asked) {
        VisibleLines seen = make_visible_lines(room.mesh, room.sight, room.light);
        std::vector<double> frame_ms;
        for (int f = 0; f < frames; f += each.every_frame ? 1 : std::max(1, frames / 24)) {
            room.caster.set_poses(poses_at(room.world, clock.time_of(f)));
            const LineScene scene{room.mesh, room.sight, room.light, room.caster, room.background, f};
            frame_ms.push_back(ms_of([&] {
                each.strategy->update(scene, {0, room.sight.lines_per_patch()}, seen, context);
            }));
        }
        const double all_ms = each.every_frame ? std::accumulate(frame_ms.begin(), frame_ms.end(), 0.0)
                                               : median(frame_ms) * frames;
        if (retraced_ms == 0) retraced_ms = all_ms;
        std::printf("%-14s %15.1f %12.3f %15.0f %10.1f\n", each.name, frame_ms.front(), median(frame_ms),
                    all_ms, retraced_ms / all_ms);
    }
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    using namespace afterglow;
    const auto option = [&](int k, double otherwise) {
        return count > k ? std::atof(arguments[k]) : otherwise;
    };
    const FrameClock clock{option(1, 24)};
    const Context context(static_cast<int>(option(4, 0)));
    LinedRoom room(assemble(load_scene(AFTERGLOW_TEST_DATA "/living-room.glb")),
                   static_cast<float>(option(2, 0.14)), static_cast<Index>(option(3, 512)), 64);
    const double all = room.world.duration_s * clock.frames_per_second;
    const int frames = static_cast<int>(option(5, all));
    std::printf("living-room, %d frames, %u patches x %u lines, %d threads\n", frames, room.mesh.size(),
                room.sight.lines_per_patch(), context.threads());
    compare_static_lines(room, clock, frames, context);
    time_light_lines(room, clock, frames, context);
    compare_own_lines(room, clock, frames, context);
    compare_whole_frames(room, clock, frames, context);
}
