#pragma once

#include <string>

#include "client/watch_view.h"

namespace afterglow::client {

/// One line for a terminal that is `columns` wide (never longer, whatever the view holds): a bar of the whole
/// job, frame k of n, revision, residual, remaining time.
std::string progress_line(const WatchView& view, int columns);

/// "frame 12 done (3 of 97): revision 4, residual 1.2 %".
std::string finished_line(const WatchView& view, const FrameImage& image);

/// "running, 97 frames", "succeeded" and the like.
std::string state_line(const WatchView& view);

}  // namespace afterglow::client
