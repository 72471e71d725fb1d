#pragma once

#include <cstdint>
#include <vector>

#include "solver/mesh/patch_mesh.h"

namespace afterglow {

/// Numbers the static patches of a mesh anew so that those that `before` has, too, keep the number they have
/// there; others take the numbers that became free, in order. What hangs on a patch's number, such as the
/// directions of its lines, so outlives a change of the furniture. Patches whose number lies past the mesh's
/// end get another one, and so do all of several that are one and the same. Returns which static patches
/// kept shape and number, by number, 1 or 0. Patches of actors keep their order. Thread-safety: pure.
std::vector<std::uint8_t> keep_numbers(const PatchMesh& before, PatchMesh& mesh);

}  // namespace afterglow
