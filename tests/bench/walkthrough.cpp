// What a camera's walk through rooms costs where light is solved everywhere at once, and where it waits until
// it comes into view: patches pushed, and CPU time with very small pictures. Counts are exact. Prints one
// table. Usage: walkthrough [lines a patch] [patch size, m] [error]

#include <cstdio>
#include <cstdlib>

#include "solver/sequence/sequence.h"
#include "tests/bench/timing.h"
#include "tests/support/rooms.h"

namespace afterglow {
namespace {

struct Way {
    const char* name;
    Solution solution;
    int ahead;
};

void measure(int rooms, const Way& way, const SequenceConfig& settings) {
    SequenceConfig config = settings;
    config.visibility = Visibility::back_buffer;
    config.solution = way.solution;
    config.frames_looked_ahead = way.ahead;
    config.revisions = Revisions::final_only;
    config.exposure_ev = 0;
    config.width = 32;
    config.height = 18;
    World world = testing::rooms_in_a_row({.rooms = rooms});
    const int last = last_frame_of(world, config);
    const Context context(1);
    SequenceState state = make_state(std::move(world), config, context);
    std::uint64_t first = 0, half = 0, all = 0;
    double first_ms = 0, all_ms = 0;
    for (int f = 0; f <= last; ++f) {
        all_ms += ms_of([&] { all += step(state, f, {}, context).shots; });
        if (f == 0) {
            first = all;
            first_ms = all_ms;
        }
        if (f <= last / 2) half = all;
    }
    std::printf("%5d %-22s %8llu %10llu %10llu %10llu %10.1f %10.1f\n", rooms, way.name,
                static_cast<unsigned long long>(state.statistics().patches),
                static_cast<unsigned long long>(first), static_cast<unsigned long long>(half),
                static_cast<unsigned long long>(all), first_ms, all_ms);
    std::fflush(stdout);
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    using namespace afterglow;
    SequenceConfig config;
    config.rays_per_patch = count > 1 ? std::atoi(arguments[1]) : 256;
    config.patch_size_m = count > 2 ? std::atof(arguments[2]) : 0.25;
    config.asked_error = count > 3 ? std::atof(arguments[3]) : 0.02;
    std::printf("%5s %-22s %8s %10s %10s %10s %10s %10s\n", "rooms", "", "patches", "first", "half way",
                "all", "first, ms", "all, ms");
    for (const int rooms : {2, 4})
        for (const Way& way :
             {Way{"everywhere", Solution::incremental, 1}, Way{"in view, 1", Solution::in_view, 1},
              Way{"in view, 24 ahead", Solution::in_view, 24}})
            measure(rooms, way, config);
}
