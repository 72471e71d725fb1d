#pragma once

#include <array>
#include <vector>

#include "solver/base/context.h"
#include "solver/mesh/surface.h"

namespace afterglow {

/// A piece of line along which something stands on a flat surface, or pierces it: light may differ from one
/// side of it to the other. In the body's frame, metres.
struct Cut {
    Vec3 from{0}, to{0};
    /// Points nearer to the line than this may lie beyond it once they are lifted off the surface, since what
    /// stands there may lean.
    float kerf_m = 0;
    std::array<bool, 2> stands_on{};  ///< by side of the surface
};

/// The cuts of all surfaces of a world.
struct Cuts {
    std::vector<std::vector<Cut>> of_surface;  ///< none on curved ones
    float lift_m = 0;                          ///< see lift_for
};

/// Finds where triangles of a body meet its flat surfaces: those that pierce one, or come nearer than lines
/// are lifted. Sheets that lie in a surface, or lean on it by less than 6°, are none. Near-linear in
/// triangles. The same result for any number of threads. Errors: cancelled. Thread-safety: pure.
Cuts find_cuts(const World& world, const Surfaces& surfaces, const Context& context = Context(1));

}  // namespace afterglow
