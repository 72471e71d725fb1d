// The report's visibility on the living room, frame after frame: how many patches share a graph, how faces
// are searched, and what the other strategies take. One iteration is the update of one frame; counts are
// means a frame. `learn_ms` is the first update: encounters, graphs, trees.

#include <chrono>

#include <benchmark/benchmark.h>

#include "solver/scene/load.h"
#include "solver/visibility/reach.h"
#include "solver/visibility/temporal_graph_strategy.h"

namespace afterglow {
namespace {

constexpr Index lines_a_patch = 128;
constexpr int frames = 48;

struct Room {
    World world = assemble(load_scene(AFTERGLOW_TEST_DATA "/living-room.glb"));
    FrameClock clock{world.frames_per_second};
    RayCaster caster{world};
    PatchMesh mesh = make();
    Lamps lamps = find_lamps(world, mesh);
    SightLines sight{mesh, world, lines_a_patch, 1};
    LightLines light{mesh, sight, lamps, 32, 2};
    StaticLines background = make_static_lines(mesh, sight, light);
    VisibleLines visible = make_visible_lines(mesh, sight, light);

    Room() { extend_static_lines(background, mesh, sight, light, caster, lines_a_patch, Context()); }
    PatchMesh make() {
        Surfaces surfaces = find_surfaces(world);
        const SideMask reached = reachable_sides(world, surfaces, caster, {}, Context());
        return make_patches(world, std::move(surfaces), reached, {.patch_size_m = 0.14F});
    }
    void look(VisibilityStrategy& strategy, int frame, const Context& context) {
        caster.set_poses(poses_at(world, clock.time_of(frame)));
        strategy.update({mesh, sight, light, caster, background, frame}, {0, lines_a_patch}, visible,
                        context);
    }
};

Room& room() {
    static Room instance;
    return instance;
}

void run_frames(benchmark::State& state, VisibilityStrategy& strategy) {
    const Context context(1);
    int frame = 1;
    for (auto _ : state) {
        room().look(strategy, frame, context);
        frame = frame % (frames - 1) + 1;
    }
}

void retrace(benchmark::State& state) {
    run_frames(state, *make_retrace());
}
void back_buffer(benchmark::State& state) {
    run_frames(state, *make_back_buffer(room().world, room().clock));
}

/// What every strategy but `retrace` spends on the actors' own lines.
void own_lines(benchmark::State& state) {
    Room& r = room();
    const LineRange own{r.sight.static_blocks(), r.sight.blocks().size(), 0, lines_a_patch};
    const Context context(1);
    for (auto _ : state)
        trace_lines(r.sight, r.mesh, r.caster, Scope::everything, own, {r.visible.patch, {}}, context);
    state.counters["patches"] = r.mesh.size();
    state.counters["own_patches"] = r.mesh.size() - r.mesh.static_size();
}

void temporal_graph(benchmark::State& state) {
    Room& r = room();
    TemporalGraphStrategy strategy(r.world, r.clock,
                                   {.grouping = static_cast<Grouping>(state.range(0)),
                                    .search = static_cast<FaceSearch>(state.range(1)),
                                    .frames_per_slice = static_cast<double>(state.range(2))});
    const auto before = std::chrono::steady_clock::now();
    r.look(strategy, 0, Context(1));
    const std::chrono::duration<double, std::milli> learning = std::chrono::steady_clock::now() - before;

    const Context context(1);
    TemporalGraphWork sum;
    int frame = 1;
    for (auto _ : state) {
        r.look(strategy, frame, context);
        sum.add(strategy.work());
        frame = frame % (frames - 1) + 1;
    }
    const auto mean = [&](std::uint64_t count) {
        return benchmark::Counter(static_cast<double>(count), benchmark::Counter::kAvgIterations);
    };
    state.counters["learn_ms"] = learning.count();
    state.counters["graphs"] = static_cast<double>(strategy.graphs());
    state.counters["kept_share"] = static_cast<double>(strategy.lines_kept(r.sight)) /
                                   (static_cast<double>(r.mesh.static_size()) * lines_a_patch);
    state.counters["graph_updates"] = mean(sum.graph_updates);
    state.counters["nodes_sorted"] = mean(sum.nodes_sorted);
    state.counters["tree_visits"] = mean(sum.tree_visits);
    state.counters["side_changes"] = mean(sum.side_changes);
    state.counters["packets"] = mean(sum.packets);
    state.counters["lines"] = mean(sum.lines_searched);
    state.counters["tests"] = mean(sum.search.line_face_tests);
    state.counters["node_visits"] = mean(sum.search.node_visits);
}

BENCHMARK(retrace)->Iterations(4)->Unit(benchmark::kMillisecond);
BENCHMARK(back_buffer)->Iterations(frames - 1)->Unit(benchmark::kMillisecond);
BENCHMARK(own_lines)->Iterations(20)->Unit(benchmark::kMillisecond);
BENCHMARK(temporal_graph)
    ->ArgNames({"grouping", "search", "slice"})
    ->ArgsProduct({{0, 1, 2, 3}, {0, 1, 2}, {4}})
    ->ArgsProduct({{1, 2}, {2}, {1, 2, 8}})
    ->Iterations(frames - 1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace afterglow
