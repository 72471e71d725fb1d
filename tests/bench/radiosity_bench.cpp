#include <cmath>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "solver/radiosity/exchange.h"
#include "solver/radiosity/progressive.h"

// Ten thousand patches on the six faces of a box, 250 sight lines each: how the two ways to exchange light
// and the shooting orders compare. Times are ratios: the machine decides the rest.

namespace afterglow {
namespace {

struct Scene {
    FormFactorMatrix matrix;
    FormFactorColumns columns;
    std::vector<float> area;
    std::vector<Rgb> emission;
    std::vector<Rgb> reflectance;

    [[nodiscard]] RadiosityProblem view() const { return {matrix, area, emission, reflectance, {}}; }
};

/// Lines of a patch end on the other five faces, near the same place on the face or anywhere on it.
enum class Spread { near, anywhere };

Scene make_scene(std::size_t patches, std::size_t lines, Spread spread) {
    Scene scene;
    std::mt19937 generator(1);
    const std::size_t face_patches = patches / 6;
    patches = face_patches * 6;
    std::normal_distribution<double> near(0, static_cast<double>(face_patches) / 8);
    std::vector<std::uint32_t> hits(patches);
    for (std::size_t i = 0; i < patches; ++i) {
        std::fill(hits.begin(), hits.end(), 0U);
        for (std::size_t k = 0; k < lines; ++k) {
            const std::size_t face = (i / face_patches + 1 + generator() % 5) % 6;
            const auto offset =
                static_cast<std::size_t>(static_cast<double>(face_patches * 8) + near(generator));
            const std::size_t on_face =
                spread == Spread::near ? (i + offset) % face_patches : generator() % face_patches;
            ++hits[face * face_patches + on_face];
        }
        for (std::size_t j = 0; j < patches; ++j) {
            if (hits[j] == 0) continue;
            scene.matrix.column.push_back(static_cast<Index>(j));
            scene.matrix.value.push_back(static_cast<float>(hits[j]) / static_cast<float>(lines));
        }
        scene.matrix.row_begin.push_back(scene.matrix.column.size());
        scene.area.push_back(0.01F);
        const bool lamp = i % face_patches < face_patches / 33 && i / face_patches == 5;
        scene.emission.push_back(lamp ? Rgb(100, 100, 90) : Rgb(0));
        const float reflectance = 0.2F + 0.1F * static_cast<float>(i / face_patches);
        scene.reflectance.push_back(Rgb(reflectance, 0.9F * reflectance, 0.8F * reflectance));
    }
    scene.columns = columns_of(scene.matrix, Context());
    return scene;
}

const Scene& scene_of(const benchmark::State& state) {
    static const Scene anywhere = make_scene(10'000, 250, Spread::anywhere);
    static const Scene near = make_scene(10'000, 250, Spread::near);
    return state.range(0) == 0 ? anywhere : near;
}

void bm_columns(benchmark::State& state) {
    const Scene& scene = scene_of(state);
    const Context context(static_cast<int>(state.range(1)));
    for (auto _ : state) benchmark::DoNotOptimize(columns_of(scene.matrix, context));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene.matrix.entries()));
}
BENCHMARK(bm_columns)->ArgsProduct({{0, 1}, {1, 2}})->UseRealTime()->Unit(benchmark::kMillisecond);

void bm_gather_all(benchmark::State& state) {
    const Scene& scene = scene_of(state);
    const Context context(static_cast<int>(state.range(1)));
    std::vector<Lanes> light(scene.area.size(), to_lanes(Rgb(1)));
    std::vector<Lanes> received(scene.area.size());
    for (auto _ : state) {
        gather(scene.matrix, light, received, context);
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene.matrix.entries()));
}
BENCHMARK(bm_gather_all)->ArgsProduct({{0, 1}, {1, 2}})->UseRealTime()->Unit(benchmark::kMillisecond);

void bm_shoot_all(benchmark::State& state) {
    const Scene& scene = scene_of(state);
    const Context context(1);
    std::vector<Index> all;
    for (std::size_t i = 0; i < scene.area.size(); ++i) all.push_back(static_cast<Index>(i));
    std::vector<Lanes> received(scene.area.size());
    for (auto _ : state) {
        shoot(scene.columns, all, scene.reflectance, received, context);
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene.matrix.entries()));
}
BENCHMARK(bm_shoot_all)->Args({0})->Args({1})->UseRealTime()->Unit(benchmark::kMillisecond);

/// A cold solution to a certificate of 2 %; the second argument is sweep_share in percent.
void bm_solve(benchmark::State& state) {
    const Scene& scene = scene_of(state);
    const Context context(static_cast<int>(state.range(2)));
    ProgressiveConfig config;
    config.sweep_share = static_cast<double>(state.range(1)) / 100;
    ProgressiveSolution solution;
    for (auto _ : state) solution = solve_progressive(scene.view(), scene.columns, config, context);
    state.counters["shots"] = static_cast<double>(solution.state.shots);
    state.counters["sweeps"] = static_cast<double>(solution.state.sweeps);
}
BENCHMARK(bm_solve)
    ->ArgsProduct({{0, 1}, {2, 10, 25, 50, 101}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void bm_solve_largest_first(benchmark::State& state) {
    const Scene& scene = scene_of(state);
    ProgressiveConfig config;
    config.order = ShootingOrder::largest_first;
    ProgressiveSolution solution;
    for (auto _ : state) solution = solve_progressive(scene.view(), scene.columns, config, Context(1));
    state.counters["shots"] = static_cast<double>(solution.state.shots);
}
BENCHMARK(bm_solve_largest_first)
    ->Args({0})
    ->Args({1})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace afterglow
