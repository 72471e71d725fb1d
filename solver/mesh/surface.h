#pragma once

#include <vector>

#include "solver/scene/world.h"

namespace afterglow {

/// Connected triangles of one body and one material that are meshed together: either flat (all in one plane)
/// or a curved collection of small facets whose neighbours meet at shallow angles.
struct Surface {
    enum class Kind { flat, curved };
    Kind kind = Kind::flat;
    Index body = 0;
    Index material = 0;
    Vec3 normal{0};                ///< of the front; the area-weighted mean where curved
    float area_m2 = 0;             ///< of one side
    std::vector<Index> triangles;  ///< of the body, in increasing order
};

/// All surfaces of a world, and the way back from triangles.
struct Surfaces {
    std::vector<Surface> list;
    std::vector<std::vector<Index>> of_triangle;  ///< [body][triangle] → index into list
};

struct SurfaceConfig {
    float facet_size_m =
        0.1F;  ///< flat pieces smaller than this in every direction may join a curved surface
    float smooth_angle = 0.7F;  ///< radians: facets that meet at less belong to one curved surface
};

/// Divides every body into surfaces, body by body in triangle order. Cost: O(n log n) in triangles.
/// Thread-safety: pure.
Surfaces find_surfaces(const World& world, const SurfaceConfig& config = {});

/// Front normal of a triangle, not normalised: its length is twice the area.
Vec3 doubled_area_normal(const Body& body, Index triangle);

}  // namespace afterglow
