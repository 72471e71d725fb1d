#pragma once

#include <chrono>
#include <stop_token>

#include "service/commands/render_options.h"

namespace afterglow {

/// `afterglowd render`: reads the scene, renders the frames one after the other and writes each as it is
/// finished. Progress and warnings go to standard error. Nothing is written before the first frame is
/// finished. `started`: when the program started, for the report. Errors: those of load_scene, apply_paths,
/// assemble, make_state and step; io where a frame cannot be written; cancelled on a stop. Files of finished
/// frames stay.
void render_command(const RenderOptions& options, const std::stop_token& stop,
                    std::chrono::steady_clock::time_point started);

}  // namespace afterglow
