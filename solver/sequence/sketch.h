#pragma once

#include "solver/sequence/sequence.h"

namespace afterglow {

// A first picture of a job's frame for somebody who waits: the whole solver on patches as large as furniture,
// with few lines each, a small part of the time that real patches take. It is thrown away: nothing that is
// made later depends on it.

/// Prepares sketches of a job with this configuration. Errors: those of make_state.
SequenceState make_sketch_state(World world, const SequenceConfig& config, const Context& context);

/// A picture of one frame, of the configuration's size and never final; its number is 1. Where no exposure is
/// asked for it has one of its own, near that of the job. Errors: invalid_input for a frame below 0,
/// cannot_converge as step, cancelled.
Revision sketch(SequenceState& state, int frame, const Context& context);

}  // namespace afterglow
