#pragma once

#include "tests/support/worlds.h"

namespace afterglow::testing {

/// How the rooms of a walkthrough are made.
struct RoomsConfig {
    int rooms = 2;              ///< in a row along x, each 5 × 2.6 × 4 m, with a lamp of its own
    unsigned seed = 1;          ///< of what stands in them
    double seconds_a_room = 3;  ///< of the camera's way
};

/// Rooms joined by doors 0.9 m wide, boxes of random grey standing in them, and a camera that begins in the
/// first room looking away from its door, turns, and walks through all doors to the far wall of the last.
/// Nothing else moves; 24 frames a second.
World rooms_in_a_row(const RoomsConfig& config);

}  // namespace afterglow::testing
