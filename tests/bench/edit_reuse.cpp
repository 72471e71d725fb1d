// What edits of a running job keep, and what they cost beside what a new job would: pieces of furniture moved
// one after the other, and the way of each actor shifted from the middle of the animation on. CPU time, one
// thread. Usage: edit_reuse SCENE [patch size, m] [lines a patch]

#include <cstdio>
#include <cstdlib>
#include <string>

#include "solver/scene/furniture.h"
#include "solver/scene/load.h"
#include "solver/sequence/furniture_edits.h"
#include "solver/sequence/parts.h"
#include "solver/visibility/events.h"
#include "tests/bench/timing.h"

namespace afterglow {
namespace {

SequenceConfig settings(double patch_size_m, int lines) {
    SequenceConfig config;
    config.visibility = Visibility::events;
    config.solution = Solution::residual;
    config.patch_size_m = patch_size_m;
    config.rays_per_patch = lines;
    config.quality = Quality::draft;
    config.width = config.height = 32;
    config.exposure_ev = 0;
    return config;
}

/// Tracing all static lines of the patches there are.
double trace_all_ms(SequenceState& state, const Context& context) {
    const SequenceState::Parts& parts = state.parts();
    StaticLines lines = make_static_lines(parts.mesh, *parts.sight, *parts.light);
    return ms_of([&] {
        extend_static_lines(lines, parts.mesh, *parts.sight, *parts.light, parts.caster,
                            parts.sight->lines_per_patch(), context);
    });
}

void move_pieces(SequenceState& state, const Context& context) {
    const float room = glm::length([&] {
        Box all;
        for (Index p = 0; p < state.parts().world.pieces.size(); ++p)
            all.add(bounds_of(state.parts().world, p));
        return all.extent();
    }());
    std::printf("%-24s %8s %10s %10s %12s\n", "piece moved by 20 cm", "size, m", "lines kept", "edit, ms",
                "tracing, ms");
    const std::vector<FurniturePiece> pieces = state.parts().world.pieces;
    for (Index p = 0; p < pieces.size(); ++p) {
        const float size = glm::length(bounds_of(state.parts().world, p).extent());
        // Walls and floors stay.
        if (size > 0.5F * room || size <= 0) continue;
        step(state, 24, {}, context);
        EditOutcome outcome;
        const double ms = ms_of([&] {
            outcome =
                move_furniture(state, pieces[p].name, {Vec3(0.16F, 0, 0.12F), Quat(1, 0, 0, 0)}, context);
        });
        std::printf("%-24s %8.2f %9.1f%% %10.0f %12.0f\n", pieces[p].name.c_str(), static_cast<double>(size),
                    100 * outcome.lines_reused, ms, trace_all_ms(state, context));
        std::fflush(stdout);
    }
}

void shift_paths(SequenceState& state, int frame, const Context& context) {
    std::printf("%-24s %10s %10s %10s %12s\n", "actor's way shifted", "lines kept", "kept ahead", "edit, ms",
                "finding, ms");
    for (Index b = 1; b < state.parts().world.bodies.size(); ++b) {
        step(state, frame, {}, context);
        const Body& body = state.parts().world.bodies[b];
        Path path = body.path;
        for (Key<Pose>& key : path.keys) key.value.translation += Vec3(0.1F, 0, 0.1F);
        const auto ahead = [&] { return total(state.statistics().work_ahead).count(); };
        EditOutcome outcome;
        const double ms =
            ms_of([&] { outcome = set_path(state, body.name, state.parts().time_of(frame), path, context); });
        // The same window found from nothing.
        state.parts().strategy = make_events(state.parts().world, state.parts().clock());
        const double before = ahead();
        step(state, frame, {}, context);
        std::printf("%-24s %9.1f%% %9.1f%% %10.0f %12.0f\n", body.name.c_str(), 100 * outcome.lines_reused,
                    100 * outcome.ahead_reused, ms, ahead() > before ? ahead() - before : ahead());
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    using namespace afterglow;
    if (count < 2) {
        std::fprintf(stderr, "usage: edit_reuse SCENE [patch size, m] [lines a patch]\n");
        return 2;
    }
    const double size_m = count > 2 ? std::atof(arguments[2]) : 0.2;
    const int lines = count > 3 ? std::atoi(arguments[3]) : 256;
    const Context context(1);
    SequenceState state =
        make_state(assemble(load_scene(std::string(AFTERGLOW_TEST_DATA "/") + arguments[1] + ".glb")),
                   settings(size_m, lines), context);
    step(state, 24, {}, context);
    std::printf("%s, %llu patches, %d lines each\n", arguments[1],
                static_cast<unsigned long long>(state.statistics().patches),
                state.statistics().rays_per_patch);
    shift_paths(state, 24, context);
    move_pieces(state, context);
}
