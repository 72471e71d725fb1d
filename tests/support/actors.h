#pragma once

#include <random>

#include "tests/support/worlds.h"

namespace afterglow::testing {

/// Adds a tetrahedron around a centre.
void add_tetrahedron(Body& body, const Vec3& centre, float size, Index material);

/// Adds a square ring around the local z axis: outer half edge `radius`, its bars `thickness` wide and deep.
void add_ring(Body& body, const Vec3& centre, float radius, float thickness, Index material);

/// What the actors of a random world do.
enum class Movements {
    straight,  ///< piecewise linear, no turning
    turning,   ///< some turn as well
};

/// The small room without its walker and with `actors` random ones: boxes, tetrahedra, rings, balls and thin
/// boards that are fast. Some share their knots, some rest for a while or jump, and some go through walls and
/// leave the room. Keys lie in [0, 4] s.
World random_world(unsigned seed, int actors, Movements movements);

/// Two rings that hang in each other and move together: neither is in front of the other.
World interlocked_rings();

/// Three bars that lie on each other in a circle, carried along.
World overlapping_bars();

}  // namespace afterglow::testing
