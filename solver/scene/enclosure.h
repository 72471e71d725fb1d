#pragma once

#include "solver/base/math.h"
#include "solver/scene/world.h"

namespace afterglow {

/// True where lines from `from` meet a surface in every direction tried: light cannot leave.
/// A small deterministic test for use at load, by brute force over all triangles at time 0: up to 64
/// directions spread evenly (a spherical Fibonacci lattice), fewer, but never below 8, where there are
/// more than a million triangles. A gap narrower than the spread can be missed. Thread-safety: pure.
bool is_enclosed(const World& world, const Vec3& from);

}  // namespace afterglow
