#pragma once

#include "solver/scene/world.h"

namespace afterglow {

/// Whether a body's faces close it, front outwards: at every edge as many faces run along one way as the
/// other, and every connected piece has a positive volume. Seen from outside such a body, the nearest face
/// always shows its front. Corners are the same where their places are, bit for bit. Thread-safety: pure.
bool is_closed_outwards(const Body& body);

}  // namespace afterglow
