#pragma once

#include "solver/scene/world.h"

namespace afterglow {

// Changes of the furniture by its pieces. All leave a world as `assemble` makes it from the scene so changed.
// `piece` is a number in World::pieces.

/// The space that a piece takes up; empty where it has no triangles.
Box bounds_of(const World& world, Index piece);

/// Moves a piece by a rigid motion from where it stands, in world coordinates.
void move_piece(World& world, Index piece, const Pose& motion);

/// Takes a piece away, with its corners: what stands nowhere counts for no bounds.
void remove_piece(World& world, Index piece);

/// Puts an object among the furniture, after all other pieces; its path counts for nothing, its positions are
/// in world coordinates. Triangles without area are left out. Errors, after which the world is as before:
/// invalid_input naming "object" for one without a name of its own or without any area, for corners or
/// materials that there are not, and for positions that are not finite.
void add_piece(World& world, const Body& object);

}  // namespace afterglow
