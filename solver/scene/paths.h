#pragma once

#include "solver/base/json.h"
#include "solver/scene/scene.h"

namespace afterglow {

/// Adds the tracks of a JSON list (docs/paths-format.md) to a scene. A track for a property that has one
/// replaces it; two in one list for the same property are an error. Tracks of materials are taken before
/// those that nodes give to their own copies of materials, so the order does not matter. The scene may be
/// half-changed after an error; `apply_paths` takes everything back.
/// `seconds_per_unit`, `metres_per_unit`: of the times and positions in the list.
/// Errors: invalid_input with the JSON pointer; names that nothing has come with names that are near.
void add_tracks(Scene& scene, const JsonView& tracks, double seconds_per_unit, double metres_per_unit);

/// The length of a document's unit of time: its member "time_unit", "s" (also where absent) or "frame".
/// Errors: invalid_input for any other.
double seconds_per_unit(const JsonView& document, double frames_per_second);

}  // namespace afterglow
