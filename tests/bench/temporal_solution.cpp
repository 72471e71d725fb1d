// What a following frame's light costs by events and residual against full, visibility and solution, on the
// living room; all in one run. Prints one table an asked error. Usage: temporal_solution [patch size, m]
// [lines a patch] [threads] [frames]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

#include "solver/radiosity/progressive.h"
#include "solver/radiosity/residual.h"
#include "solver/scene/load.h"
#include "solver/visibility/events.h"
#include "tests/bench/room.h"
#include "tests/bench/timing.h"

namespace afterglow {
namespace {

/// CPU times of the stages of each frame.
struct Stages {
    std::vector<double> look, rows, solve;
    [[nodiscard]] double sum() const { return median(look) + median(rows) + median(solve); }
};

/// Root mean square over area of what two irradiances reflect differently, relative to the mean.
double rms(const RadiosityProblem& problem, std::span<const Rgb> a, std::span<const Rgb> exact) {
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Rgb d = problem.reflectance[i] * (a[i] - exact[i]);
        sum += static_cast<double>(problem.area[i] * glm::dot(d, d)) / 3;
        area += static_cast<double>(problem.area[i]);
    }
    return std::sqrt(sum / area) / mean_reflected(problem, exact);
}

void print(const char* name, const Stages& stages) {
    std::printf("%-18s %9.2f %9.2f %9.2f %9.2f\n", name, median(stages.look), median(stages.rows),
                median(stages.solve), stages.sum());
}

void compare(LitRoom& room, double asked, int frames, const Context& context) {
    const FrameClock clock{24};
    VisibleLines shown = make_visible_lines(room.mesh, room.sight, room.light), anew = shown;
    const auto events = make_events(room.world, clock), retrace = make_retrace();
    LayeredMatrix matrix;
    ResidualState state;
    Stages ours, full;
    ResidualConfig residual;
    residual.asked_error = asked;
    ProgressiveConfig progressive;
    progressive.asked_error = asked;
    std::vector<double> pushes, rounds, sweeps, changes, error, full_error;
    double first_ms = 0;
    for (int f = 0; f < frames; ++f) {
        room.caster.set_poses(poses_at(room.world, clock.time_of(f)));
        const double look = ms_of([&] { events->update(room.lines(f), room.all(), shown, context); });
        auto listed = events->take_changes();
        const ResidualProblem problem{matrix, room.mesh.area_m2, room.emission, room.reflectance,
                                      room.external};
        if (f == 0) {
            first_ms = ms_of([&] {
                matrix = make_layered_matrix(room.layers(), context);
                show(matrix, room.layers(), shown, context);
                state = make_residual_state(problem, context);
                step(state, problem, residual, context);
            });
            continue;
        }
        std::span<const RowChanges> changed;
        ours.look.push_back(look);
        ours.rows.push_back(ms_of([&] {
            changed = listed ? show(matrix, room.layers(), shown, std::move(*listed), context)
                             : show(matrix, room.layers(), shown, context);
        }));
        const std::uint64_t before[] = {state.pushes, state.rounds, state.sweeps};
        ours.solve.push_back(ms_of([&] {
            follow(state, problem, changed, context);
            step(state, problem, residual, context);
        }));
        pushes.push_back(static_cast<double>(state.pushes - before[0]));
        rounds.push_back(static_cast<double>(state.rounds - before[1]));
        sweeps.push_back(static_cast<double>(state.sweeps - before[2]));
        changes.push_back(static_cast<double>(lines_changed(changed)));
        if (f % std::max(2, frames / 6) != 1) continue;
        full.look.push_back(ms_of([&] { retrace->update(room.lines(f), room.all(), anew, context); }));
        FormFactors factors;
        FormFactorColumns columns;
        full.rows.push_back(ms_of([&] {
            factors =
                compile_rows(room.mesh, room.sight, room.light, room.lamps, room.caster,
                             {anew.patch, room.sight.lines_per_patch(), anew.light_contribution}, context);
            columns = columns_of(factors.matrix, context);
        }));
        ProgressiveSolution cold;
        full.solve.push_back(ms_of(
            [&] { cold = solve_progressive(room.problem(factors.matrix), columns, progressive, context); }));
        ProgressiveConfig exactly;
        exactly.asked_error = 1e-4;
        const auto exact = solve_progressive(room.problem(factors.matrix), columns, exactly, context);
        error.push_back(rms(room.problem(factors.matrix), state.irradiance, exact.state.irradiance));
        full_error.push_back(
            rms(room.problem(factors.matrix), cold.state.irradiance, exact.state.irradiance));
    }
    std::printf("\ncertificate %g %%: medians, ms of CPU time a frame\n", 100 * asked);
    std::printf("%-18s %9s %9s %9s %9s\n", "", "look", "rows", "solve", "sum");
    print("full", full);
    print("events, residual", ours);
    std::printf("ratio %.1f, without looking %.1f; RMS error of the solution %.3f %%, of full %.3f %%\n",
                full.sum() / ours.sum(),
                (median(full.rows) + median(full.solve)) / (median(ours.rows) + median(ours.solve)),
                100 * median(error), 100 * median(full_error));
    std::printf("changes %.0f, pushes %.0f, rounds %.0f, sweeps %.0f; first frame's rows and light %.0f ms\n",
                median(changes), median(pushes), median(rounds), median(sweeps), first_ms);
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    using namespace afterglow;
    const auto option = [&](int k, double otherwise) {
        return count > k ? std::atof(arguments[k]) : otherwise;
    };
    const Context context(static_cast<int>(option(3, 1)));
    LitRoom room(assemble(load_scene(AFTERGLOW_TEST_DATA "/living-room.glb")),
                 static_cast<float>(option(1, 0.14)), static_cast<Index>(option(2, 512)), 64);
    const int frames = static_cast<int>(option(4, 25));
    extend_static_lines(room.background, room.mesh, room.sight, room.light, room.caster,
                        room.sight.lines_per_patch(), context);
    std::printf("living-room, %d frames, %u patches x %u lines, %d threads\n", frames, room.mesh.size(),
                room.sight.lines_per_patch(), context.threads());
    for (const double asked : {0.05, 0.01}) compare(room, asked, frames, context);
}
