#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "solver/base/math.h"

// Planar polygons in double precision: what the closed forms work on.

namespace afterglow {

using Vec3d = glm::dvec3;  ///< metres
inline constexpr double pi_d = 3.14159265358979323846;

/// The points x with normal · x = offset_m; those with more are in front.
struct Plane {
    Vec3d normal{0, 0, 1};  ///< unit
    double offset_m = 0;

    [[nodiscard]] double height(const Vec3d& x) const { return glm::dot(normal, x) - offset_m; }
};

/// Area, m², times the unit normal: corners run counter-clockwise seen from the side it points to. Exact for
/// simple polygons, convex or not. Source: Newell's method. Thread-safety: pure.
Vec3d area_vector(std::span<const Vec3d> corners);

/// The plane through the polygon's mean corner, its normal that of `area_vector`. The area must not be 0.
Plane plane_of(std::span<const Vec3d> corners);

/// The part of a polygon in front of a plane; corners that are `tolerance_m` or less off it count as in
/// it, and nothing is left of a polygon with no corner in front.
/// Parts of a polygon that is not convex stay joined by edges run through both ways, which add nothing to any
/// contour integral. `out` must not be the same storage as `corners`. Source: Sutherland and Hodgman 1974.
void clip_to_front(std::span<const Vec3d> corners, const Plane& plane, double tolerance_m,
                   std::vector<Vec3d>& out);

/// Errors: invalid_input, with `place`, where there are fewer than three corners, one is not finite, they are
/// not in one plane (to 1e-4 of the polygon's extent), or the area is zero (below 1e-12 of the extent's
/// square). That edges do not cross is not checked.
void check_polygon(std::span<const Vec3d> corners, std::string_view place);

}  // namespace afterglow
