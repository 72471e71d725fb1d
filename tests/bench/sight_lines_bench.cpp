// The static pass of the living room three ways: packets of one direction × 16 neighbouring patches (the
// report's linear virtual motion), packets of 16 directions of one patch (its circular one), and single rays.
// Same lines each time. And what it would cost if the patches of a packet shared their directions turned
// about the normal by an angle of each, or not at all.

#include <cmath>

#include <benchmark/benchmark.h>

#include "solver/scene/load.h"
#include "solver/visibility/reach.h"
#include "solver/visibility/sight_lines.h"

namespace afterglow {
namespace {

struct Room {
    World world = assemble(load_scene(AFTERGLOW_TEST_DATA "/living-room.glb"));
    RayCaster caster{world};
    PatchMesh mesh = make();
    SightLines lines{mesh, world, 256, 1};
    LineTargets targets;

    Room() {
        targets.patch.resize(std::size_t{mesh.size()} * 256);
        targets.distance.resize(targets.patch.size());
    }
    PatchMesh make() {
        Surfaces surfaces = find_surfaces(world);
        const SideMask reached = reachable_sides(world, surfaces, caster, {}, Context());
        return make_patches(world, std::move(surfaces), reached, {.patch_size_m = 0.14F});
    }
};

Room& room() {
    static Room instance;
    return instance;
}

void count_rays(benchmark::State& state) {
    const double rays = static_cast<double>(room().lines.static_blocks()) * block_size * 256;
    state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsIterationInvariantRate);
    state.counters["patches"] = static_cast<double>(room().mesh.size());
}

/// Calls `body(block)` for all static blocks on all threads.
template <class Body>
void for_static_blocks(const Context& context, const Body& body) {
    context.for_chunks(room().lines.static_blocks(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) body(b);
    });
}

void static_pass(benchmark::State& state) {
    const Context context(static_cast<int>(state.range(0)));
    Room& r = room();
    for (auto _ : state) {
        benchmark::DoNotOptimize(trace_lines(r.lines, r.mesh, r.caster, Scope::static_geometry,
                                             {0, r.lines.static_blocks(), 0, 256},
                                             {r.targets.patch, r.targets.distance}, context));
    }
    count_rays(state);
}

/// What the lines of a packet have in common.
enum class Directions {
    turned,  ///< all but an angle about the normal, each patch its own
    own,     ///< nothing
};

/// The rays of one direction of a block of the furniture, made anew as SightLines does.
void rays_with(Directions directions, std::size_t block, Index direction, RayPacket& out) {
    static const SobolPoints points(256);
    const PatchBlock& b = room().lines.blocks()[block];
    const Sample4 shared = points.at(direction, mixed(1, block));
    const Vec3 shared_direction = cosine_direction(shared[0], shared[1]);
    out.count = b.count;
    for (Index lane = 0; lane < b.count; ++lane) {
        const std::uint64_t seed = mixed(mixed(1), b.first + lane);
        Sample4 sample = shared;
        Vec3 local = shared_direction;
        if (directions == Directions::own) {
            sample = points.at(direction, seed);
            local = cosine_direction(sample[0], sample[1]);
        } else {
            const float angle = 2 * pi * static_cast<float>(seed >> 40U) * 0x1p-24F;
            const float c = std::cos(angle), s = std::sin(angle);
            local = {c * local.x - s * local.y, s * local.x + c * local.y, local.z};
        }
        const PatchPoint point = room().mesh.point_on(b.first + lane, sample[2], sample[3]);
        out.set(lane,
                {point.position + room().lines.lift_m() * point.normal, Frame(point.normal).to_world(local)});
    }
}

template <Directions directions>
void packets_with(benchmark::State& state) {
    const Context context(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        for_static_blocks(context, [](std::size_t b) {
            RayPacket rays;
            HitPacket hits;
            for (Index d = 0; d < 256; ++d) {
                rays_with(directions, b, d, rays);
                room().caster.nearest(rays, Scope::static_geometry, hits);
                benchmark::DoNotOptimize(hits);
            }
        });
    }
    count_rays(state);
}

void packets_over_neighbours(benchmark::State& state) {
    const Context context(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        for_static_blocks(context, [](std::size_t b) {
            RayPacket rays;
            HitPacket hits;
            for (Index d = 0; d < 256; ++d) {
                room().lines.rays(b, d, Pose{}, rays);
                room().caster.nearest(rays, Scope::static_geometry, hits);
                benchmark::DoNotOptimize(hits);
            }
        });
    }
    count_rays(state);
}

/// The rays of a block, sorted patch by patch, so that 16 successive directions of one patch stand together.
std::vector<Ray> rays_by_patch(std::size_t block) {
    std::vector<Ray> all(std::size_t{block_size} * 256);
    RayPacket rays;
    for (Index d = 0; d < 256; ++d) {
        room().lines.rays(block, d, Pose{}, rays);
        for (Index lane = 0; lane < rays.count; ++lane) all[std::size_t{lane} * 256 + d] = rays.ray(lane);
    }
    all.resize(std::size_t{room().lines.blocks()[block].count} * 256);
    return all;
}

void packets_over_directions(benchmark::State& state) {
    const Context context(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        for_static_blocks(context, [](std::size_t b) {
            const std::vector<Ray> all = rays_by_patch(b);
            RayPacket rays;
            HitPacket hits;
            for (std::size_t first = 0; first < all.size(); first += 16) {
                rays.count = 16;
                for (std::size_t lane = 0; lane < 16; ++lane) rays.set(lane, all[first + lane]);
                room().caster.nearest(rays, Scope::static_geometry, hits);
                benchmark::DoNotOptimize(hits);
            }
        });
    }
    count_rays(state);
}

void single_rays(benchmark::State& state) {
    const Context context(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        for_static_blocks(context, [](std::size_t b) {
            for (const Ray& ray : rays_by_patch(b))
                benchmark::DoNotOptimize(room().caster.nearest(ray, Scope::static_geometry));
        });
    }
    count_rays(state);
}

BENCHMARK(static_pass)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(packets_over_neighbours)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(packets_with<Directions::turned>)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(packets_with<Directions::own>)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(packets_over_directions)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(single_rays)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace afterglow
