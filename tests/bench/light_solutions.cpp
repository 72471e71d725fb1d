// What each way to solve the light costs on the living room: shooting orders and channels, what passive
// patches save for a fixed view and what they miss, and an animation followed frame by frame. All in one run;
// prints tables. Work is given in sweeps, that is form factors used over form factors there are.
// Usage: light_solutions [patch size, m] [lines a patch] [frames]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

#include "solver/image/camera.h"
#include "solver/radiosity/active_passive.h"
#include "solver/scene/load.h"
#include "tests/bench/timing.h"
#include "tests/support/solved_world.h"

namespace afterglow {
namespace {

using testing::SolvedWorld;

constexpr double frames_per_second = 24;
const Context one_thread(1);

/// Which patches are seen, which move, and what they belong to.
struct Roles {
    std::vector<std::uint8_t> seen, moving;
    std::vector<Index> object, surface;

    [[nodiscard]] PatchRoles view() const { return {seen, moving, object, surface}; }
};

Roles roles_of(const SolvedWorld& w, double time_s) {
    constexpr int width = 640;
    constexpr int height = 360;
    Roles roles;
    roles.seen.assign(w.mesh.size(), 0);
    const CameraView view = view_at(w.world.cameras.front(), time_s, width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Ray ray = view.ray(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
            const Index patch = target_of(w.caster.nearest(ray, Scope::everything), ray, w.mesh, w.caster);
            if (patch < w.mesh.size()) roles.seen[patch] = 1;
        }
    for (Index p = 0; p < w.mesh.size(); ++p) roles.moving.push_back(w.mesh.body[p] != furniture ? 1 : 0);
    roles.surface.assign(w.mesh.surface.begin(), w.mesh.surface.end());
    roles.object.assign(w.mesh.body.begin(), w.mesh.body.end());
    return roles;
}

/// Relative error of ρH over the seen patches, area-weighted root mean square, per cent.
double seen_error(const RadiosityProblem& problem, const Roles& roles, const std::vector<Rgb>& irradiance,
                  const std::vector<Rgb>& exact) {
    double square = 0;
    double mean = 0;
    double area = 0;
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        if (roles.seen[i] == 0) continue;
        const double a = problem.area[i];
        const Rgb off = problem.reflectance[i] * (irradiance[i] - exact[i]);
        const Rgb light = problem.reflectance[i] * exact[i];
        area += a;
        square += a * static_cast<double>(glm::dot(off, off)) / 3;
        mean += a * static_cast<double>(light.r + light.g + light.b) / 3;
    }
    return 100 * std::sqrt(square / area) / (mean / area);
}

void compare_orders(const SolvedWorld& w, const Roles& roles, const FormFactorColumns& columns) {
    const double all = static_cast<double>(w.factors.matrix.entries());
    std::printf("\ncold, certificate 2 %%            shots   sweeps' work   CPU ms\n");
    const std::pair<const char*, ShootingOrder> orders[] = {{"threshold-scan", ShootingOrder::threshold_scan},
                                                            {"estimated", ShootingOrder::estimated},
                                                            {"report", ShootingOrder::report},
                                                            {"largest-first", ShootingOrder::largest_first}};
    for (const double share : {0.25, 2.0})
        for (const auto& [name, order] : orders) {
            ProgressiveConfig config;
            config.order = order;
            config.sweep_share = share;
            config.roles = roles.view();
            ProgressiveSolution s;
            std::vector<double> ms;
            for (int k = 0; k < (order == ShootingOrder::largest_first ? 1 : 5); ++k)
                ms.push_back(ms_of([&] { s = solve_progressive(w.problem(), columns, config, one_thread); }));
            std::printf("%-16s %-13s %7llu %10.2f %12.1f\n", name, share > 1 ? "shots alone" : "with sweeps",
                        static_cast<unsigned long long>(s.state.shots),
                        static_cast<double>(s.state.entries) / all, median(ms));
        }
}

/// The three channels together and each alone, under lamps as they are and under lamps of one channel each.
void compare_channels(const SolvedWorld& w, const FormFactorColumns& columns) {
    const double all = static_cast<double>(w.factors.matrix.entries());
    std::printf("\nchannels, certificate 2 %%, sweeps' work: together / red, green, blue alone\n");
    for (const bool tinted : {false, true}) {
        std::vector<Rgb> emission = w.emission;
        // A third of the lamps' patches, in their order, shines in each channel.
        for (std::size_t k = 0; tinted && k < w.lamps.patches.size(); ++k) {
            const Index p = w.lamps.patches[k];
            const auto channel = static_cast<int>(3 * k / w.lamps.patches.size());
            Rgb one(0);
            one[channel] = emission[p][channel];
            emission[p] = one;
        }
        const auto work = [&](const std::vector<Rgb>& light) {
            const RadiosityProblem problem{w.factors.matrix, w.mesh.area_m2, light, w.reflectance, {}};
            ProgressiveConfig config;
            config.sweep_share = 2;
            config.finish = Finish::bound;
            return static_cast<double>(
                       solve_progressive(problem, columns, config, one_thread).state.entries) /
                   all;
        };
        std::printf("%-22s %8.2f /", tinted ? "a channel a lamp" : "lamps as they are", work(emission));
        for (int c = 0; c < 3; ++c) {
            std::vector<Rgb> alone(emission.size(), Rgb(0));
            for (std::size_t p = 0; p < alone.size(); ++p) alone[p][c] = emission[p][c];
            std::printf(" %8.2f", work(alone));
        }
        std::printf("\n");
    }
}

/// What is left out by surfaces or patch by patch: work until the seen patches are within errors of their
/// exact light, time and error of a whole solution.
void compare_culling(const SolvedWorld& w, const Roles& known, const FormFactorColumns& columns) {
    const double all = static_cast<double>(w.factors.matrix.entries());
    const RadiosityProblem problem = w.problem();
    std::printf(
        "\nfixed view, cold, shots alone  passive  seen within 10, 5, 2, 1 %%: sweeps' work   "
        "to 2 %% of active: shots, work, CPU ms, seen error   certificate of all\n");
    const auto row = [&](const char* name, const PatchRoles& roles, double share, ShootingOrder order) {
        ActivePassiveConfig config;
        config.order = order;
        config.asked_error = 0.002;
        config.passive_share = share;
        config.sweep_share = 2;
        config.max_shots = 100;
        auto state = make_active_passive_state(problem, roles, config, one_thread);
        std::printf("%-25s %5.3f %10ld  ", name, share,
                    static_cast<long>(std::ranges::count(state.active, 0)));
        const double levels[] = {10, 5, 2, 1};
        std::size_t level = 0;
        while (state.status == ProgressiveStatus::running && level < std::size(levels)) {
            step(state, problem, columns, roles, config, one_thread);
            const double error = seen_error(problem, known, state.irradiance, w.solution.state.irradiance);
            for (; level < std::size(levels) && error <= levels[level]; ++level)
                std::printf("%6.2f", static_cast<double>(state.entries) / all);
        }
        config = {};
        config.order = order;
        config.goal = Goal::active;
        config.passive_share = share;
        std::vector<double> ms;
        ActivePassiveSolution s;
        for (int k = 0; k < 5; ++k)
            ms.push_back(
                ms_of([&] { s = solve_active_passive(problem, columns, roles, config, one_thread); }));
        std::printf("  %12llu %8.2f %8.1f %8.2f %%  %8.2f %%\n",
                    static_cast<unsigned long long>(s.state.shots),
                    static_cast<double>(s.state.entries) / all, median(ms),
                    seen_error(problem, known, s.state.irradiance, w.solution.state.irradiance),
                    100 * s.certificate.error_bound);
    };
    const auto scan = ShootingOrder::threshold_scan;
    row("none", {}, 0, scan);
    for (const double share : {0.005, 0.01, 0.02, 0.05, 0.1}) row("surfaces", known.view(), share, scan);
    row("the same, report's order", known.view(), 0.02, ShootingOrder::report);
    for (const double share : {0.01, 0.02, 0.05})
        row("patches", {known.seen, known.moving, {}, {}}, share, scan);
}

/// One way to follow an animation, and its costs a frame.
struct Following {
    const char* name;
    double sweep_share = 0.25;
    double batch_share = 0.5;
    Finish finish = Finish::bound;
    std::vector<double> shots = {}, work = {}, change_ms = {}, solve_ms = {};
    IncrementalState state = {};
};

void follow(Following& f, const SolvedWorld& w, const FormFactorColumns& columns,
            const std::vector<Index>& rows, bool cold) {
    ProgressiveConfig config;
    config.finish = f.finish;
    config.sweep_share = f.sweep_share;
    config.batch_share = f.batch_share;
    const std::uint64_t shots = f.state.shots;
    const std::uint64_t entries = f.state.entries;
    const double change_ms = ms_of([&] {
        if (cold)
            f.state = make_incremental_state(w.problem(), one_thread);
        else
            change(f.state, w.problem(), rows, one_thread);
    });
    const double ms = ms_of([&] { step(f.state, w.problem(), columns, config, one_thread); });
    f.change_ms.push_back(change_ms);
    f.solve_ms.push_back(ms);
    f.shots.push_back(static_cast<double>(f.state.shots - (cold ? 0 : shots)));
    f.work.push_back(static_cast<double>(f.state.entries - (cold ? 0 : entries)) /
                     static_cast<double>(w.factors.matrix.entries()));
}

void compare_following(SolvedWorld& w, int frames) {
    Following ways[] = {{"cold", 0.25, 0.5, Finish::sweep},
                        {"incremental, a sweep a frame", 0.25, 0.5, Finish::sweep},
                        {"incremental, counted rounding", 0.25, 0.5, Finish::bound},
                        {"the same, batches of 1/16", 0.25, 1.0 / 16, Finish::bound},
                        {"the same, never a sweep", 2, 1.0 / 16, Finish::bound}};
    std::vector<double> changed, compare_ms;
    FormFactorMatrix before = w.factors.matrix;
    for (int frame = 0; frame <= frames; ++frame) {
        w.look(frame / frames_per_second);
        std::vector<Index> rows;
        compare_ms.push_back(ms_of([&] { rows = changed_rows(before, w.factors.matrix, one_thread); }));
        changed.push_back(static_cast<double>(rows.size()));
        const FormFactorColumns columns = columns_of(w.factors.matrix, one_thread);
        for (Following& f : ways) follow(f, w, columns, rows, frame == 0 || &f == &ways[0]);
        before = w.factors.matrix;
    }
    std::printf("\nframes 1 to %d, medians; %.0f rows of %u change, found in %.1f CPU ms\n", frames,
                median(changed), w.mesh.size(), median(compare_ms));
    std::printf("certificate 2 %%                     shots   sweeps' work   change ms   solve ms\n");
    for (Following& f : ways) {
        for (auto* values : {&f.shots, &f.work, &f.change_ms, &f.solve_ms}) values->erase(values->begin());
        std::printf("%-30s %9.0f %10.2f %12.1f %10.1f\n", f.name, median(f.shots), median(f.work),
                    median(f.change_ms), median(f.solve_ms));
    }
}

void run(float patch_size_m, Index lines, int frames) {
    testing::SolvedWorldConfig config;
    config.patch_size_m = patch_size_m;
    config.lines = lines;
    config.asked_error = 1e-4;
    SolvedWorld w(assemble(load_scene(AFTERGLOW_TEST_DATA "/living-room.glb")), config);
    w.solve(0);
    const Roles roles = roles_of(w, 0);
    const FormFactorColumns columns = columns_of(w.factors.matrix, one_thread);
    std::printf("%u patches, %zu entries, %ld patches seen\n", w.mesh.size(), w.factors.matrix.entries(),
                static_cast<long>(std::ranges::count(roles.seen, 1)));
    compare_orders(w, roles, columns);
    compare_channels(w, columns);
    compare_culling(w, roles, columns);
    compare_following(w, frames);
}

}  // namespace
}  // namespace afterglow

int main(int argc, char** argv) {
    const float patch_size_m = argc > 1 ? std::strtof(argv[1], nullptr) : 0.15F;
    const int lines = argc > 2 ? std::atoi(argv[2]) : 256;
    const int frames = argc > 3 ? std::atoi(argv[3]) : 12;
    afterglow::run(patch_size_m, static_cast<afterglow::Index>(lines), frames);
    return 0;
}
