#pragma once

#include "solver/visibility/motion.h"
#include "solver/visibility/strategy.h"

namespace afterglow {

struct EventsConfig {
    /// Frames whose events are found together, 1 to 4096; more cost memory, fewer time.
    int frames_per_window = 128;
    /// The same for the window of the first frame asked for, so that it need not wait for many others; 1 or
    /// more. Each window after it is four times as long as the one before, up to frames_per_window.
    int frames_of_first_window = 8;
};

/// The frames whose events are found together with a frame's, where `start` was the first one asked for:
/// windows grow from there on; before it all have full length, but begin no earlier than frame 0. The
/// windows of a start hold each frame once, whatever is asked for in which order.
FrameSpan event_window(int frame, int start, const EventsConfig& config);

/// Finds, for a window of frames at once, in which frame each line of a static patch comes to see something
/// else; a frame then touches the lines that change and no others. Frames may be asked for in any order; one
/// outside the window begins a new one. The static patches' lines see what `retrace` shows them, ties aside;
/// actors' own lines, too, see own_lines.h. Where nothing ever moves it is `back-buffer`, without a window.
/// `visible` must be given back as the call before left it. Keeps references to its arguments. Errors:
/// invalid_input for windows without frames. Of update: too_large past 2³² lines; cancelled, after which the
/// next call begins anew.
std::unique_ptr<VisibilityStrategy> make_events(const World& world, const FrameClock& clock,
                                                const EventsConfig& config = {});

}  // namespace afterglow
