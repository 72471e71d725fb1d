#pragma once

#include "solver/visibility/ray_caster.h"

namespace afterglow::testing {

/// The nearest hit by trying every triangle of every body at its pose, in double precision: the oracle of the
/// ray caster. Source: Möller and Trumbore 1997.
Hit nearest_by_brute_force(const World& world, std::span<const Pose> poses, const Ray& ray, Scope scope);

/// How far, relative to the triangle, a hit is from its border: differences of hits on an edge are ties.
double distance_from_edge(const Hit& hit);

}  // namespace afterglow::testing
