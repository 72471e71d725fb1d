#pragma once

#include "solver/visibility/motion.h"
#include "solver/visibility/strategy.h"

namespace afterglow {

struct EventsConfig {
    int frames_per_window =
        128;  ///< frames whose events are found together, 1 to 4096; more cost memory, fewer time
};

/// Finds, for a window of frames at once, in which frame each line of a static patch comes to see something
/// else; a frame then touches the lines that change and no others. Frames may be asked for in any order; one
/// outside the window begins a new one. The static patches' lines see what `retrace` shows them, ties aside;
/// actors' own lines, too, see own_lines.h. Where nothing ever moves it is `back-buffer`, without a window.
/// Keeps references to its arguments. Errors of update: too_large past 2³² lines; cancelled, after which the
/// next call begins anew.
std::unique_ptr<VisibilityStrategy> make_events(const World& world, const FrameClock& clock,
                                                const EventsConfig& config = {});

}  // namespace afterglow
