// How the work of a following frame's light grows with the number of patches: the living room in even patches
// from a few thousand to a few hundred thousand, the same actors at the same speed, events and residual. All
// figures are exact counts, medians over frames; at the end the exponents that fit them best. Usage:
// solution_growth [lines a patch] [frames] [certificate] [threads]

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "solver/radiosity/residual.h"
#include "solver/scene/load.h"
#include "solver/visibility/events.h"
#include "tests/bench/room.h"
#include "tests/bench/timing.h"

namespace afterglow {
namespace {

/// What one frame takes; [0] is the number of patches.
enum Measure { patches, changes, pushes, rounds, pushed_entries, touched_mb, measures };
using Counts = std::array<double, measures>;
constexpr const char* names[] = {"patches", "changes", "pushes", "rounds", "pushed entries", "MB touched"};

// Bytes that are read or written for an entry that a push goes along (the entry, what its row receives), for
// a row in a round (what it receives, its residual, share and magnitude) and for a change of a line.
constexpr double bytes_per_entry = 4 + sizeof(Lanes);
constexpr double bytes_per_row = 4 * sizeof(Lanes) + 2 * sizeof(float);
constexpr double bytes_per_change = sizeof(RowChange) + 2 * sizeof(Lanes) + 2 * sizeof(DoubleLanes);

Counts count(const World& world, float patch_size_m, Index lines, int frames, double asked,
             const Context& context) {
    LitRoom room(world, patch_size_m, lines, std::max(lines / 4, Index{16}));
    extend_static_lines(room.background, room.mesh, room.sight, room.light, room.caster, lines, context);
    const FrameClock clock{24};
    VisibleLines shown = make_visible_lines(room.mesh, room.sight, room.light);
    const auto events =
        make_events(room.world, clock, {.frames_per_window = frames, .frames_of_first_window = frames});
    LayeredMatrix matrix;
    ResidualState state;
    ResidualConfig config;
    config.asked_error = asked;
    const ResidualProblem problem{matrix, room.mesh.area_m2, room.emission, room.reflectance, room.external};
    std::array<std::vector<double>, measures> all;
    for (int f = 0; f < frames; ++f) {
        room.caster.set_poses(poses_at(room.world, clock.time_of(f)));
        events->update(room.lines(f), {0, lines}, shown, context);
        auto listed = events->take_changes();
        if (f == 0) {
            matrix = make_layered_matrix(room.layers(), context);
            show(matrix, room.layers(), shown, context);
            state = make_residual_state(problem, context);
            step(state, problem, config, context);
            continue;
        }
        const auto changed = listed ? show(matrix, room.layers(), shown, std::move(*listed), context)
                                    : show(matrix, room.layers(), shown, context);
        const ResidualState before = state;
        follow(state, problem, changed, context);
        step(state, problem, config, context);
        const double k = static_cast<double>(lines_changed(changed));
        const auto gained = [&](std::uint64_t ResidualState::*member) {
            return static_cast<double>(state.*member - before.*member);
        };
        const double entries = gained(&ResidualState::entries);
        all[changes].push_back(k);
        all[pushes].push_back(gained(&ResidualState::pushes));
        all[rounds].push_back(gained(&ResidualState::rounds));
        all[pushed_entries].push_back(entries);
        all[touched_mb].push_back(1e-6 *
                                  (k * bytes_per_change + entries * bytes_per_entry +
                                   (gained(&ResidualState::rounds) + 2) * room.mesh.size() * bytes_per_row));
    }
    Counts out{static_cast<double>(room.mesh.size())};
    for (int m = changes; m < measures; ++m)
        out[static_cast<std::size_t>(m)] = median(all[static_cast<std::size_t>(m)]);
    return out;
}

/// The slope of the straight line nearest to the points, both axes logarithmic.
double exponent(std::span<const Counts> rows, Measure of, Measure against) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Counts& row : rows) {
        if (row[of] <= 0 || row[against] <= 0) continue;
        const double a = std::log(row[against]), b = std::log(row[of]);
        n += 1;
        x += a;
        y += b;
        xx += a * a;
        xy += a * b;
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

void run(Index lines, int frames, double asked, const Context& context) {
    const World world = assemble(load_scene(AFTERGLOW_TEST_DATA "/living-room.glb"));
    std::vector<Counts> rows;
    for (const char* name : names) std::printf("%16s", name);
    std::printf("\n");
    for (const float size : {0.36F, 0.2F, 0.11F, 0.06F, 0.033F}) {
        rows.push_back(count(world, size, lines, frames, asked, context));
        for (const double value : rows.back()) std::printf("%16.4g", value);
        std::printf("\n");
        std::fflush(stdout);
    }
    for (const Measure against : {patches, changes}) {
        std::printf("exponents against %s:\n", names[against]);
        for (int m = changes; m < measures; ++m)
            std::printf("%16s %.2f\n", names[m], exponent(rows, static_cast<Measure>(m), against));
    }
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    using namespace afterglow;
    const auto option = [&](int k, double otherwise) {
        return count > k ? std::atof(arguments[k]) : otherwise;
    };
    run(static_cast<Index>(option(1, 64)), static_cast<int>(option(2, 13)), option(3, 0.02),
        Context(static_cast<int>(option(4, 1))));
}
