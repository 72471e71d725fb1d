#pragma once

#include <vector>

#include "solver/scene/world.h"

namespace afterglow {

/// The number of each position among the different ones: corners are the same where their places are, bit for
/// bit. Thread-safety: pure.
std::vector<Index> joined_positions(const Body& body);

/// Whether a body's faces close it, front outwards: at every edge as many faces run along one way as the
/// other, and every connected piece has a positive volume. Seen from outside such a body, the nearest face
/// always shows its front. Thread-safety: pure.
bool is_closed_outwards(const Body& body);

}  // namespace afterglow
