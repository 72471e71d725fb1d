#pragma once

#include "solver/base/json.h"
#include "solver/scene/names.h"
#include "solver/scene/scene.h"

namespace afterglow {

/// True for the forms of "geometry" that stand in the document itself: positions, box, quad.
bool is_inline_geometry(const JsonView& geometry);

/// The mesh that such a "geometry" describes. `materials` finds the one it names.
/// Errors: invalid_input with the JSON pointer.
Mesh inline_mesh(const JsonView& geometry, const Names& materials, double metres_per_unit);

}  // namespace afterglow
