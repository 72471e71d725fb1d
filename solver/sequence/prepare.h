#pragma once

#include "solver/sequence/parts.h"

namespace afterglow {

/// Errors: invalid_input naming the first setting that is out of its range.
void check(const SequenceConfig& config);

/// Chooses the sides that get patches, divides them, lays the lines and finds the lamps.
void mesh_world(SequenceState::Parts& parts, const Context& context);

/// Its two steps: chooses the sides that get patches and divides them; lays the lines and finds the lamps.
void divide_world(SequenceState::Parts& parts, const Context& context);
void lay_lines(SequenceState::Parts& parts);

/// Whether light, as the world now is, reaches sides that got no patches when it was meshed.
bool reaches_more(SequenceState::Parts& parts, const Context& context);

/// Lays the lines to the lamps that were found.
void lay_light_lines(SequenceState::Parts& parts);

/// The camera of a given name, the first one for an empty name. Errors: not_found, listing the names.
PlacedCamera find_camera(const World& world, const std::string& name);

/// Traces the static pass on to `directions`, or reads it whole from the cache, and keeps it once it is
/// whole. Returns the number of rays and adds the time to the statistics. A cache that cannot be written is a
/// warning, not an error.
std::uint64_t advance_static_pass(SequenceState::Parts& parts, Index directions, const Context& context);

}  // namespace afterglow
