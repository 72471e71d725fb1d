#pragma once

#include <span>

#include "solver/formfactor/polygon.h"

namespace afterglow {

/// F from one planar polygon to another with nothing in between: the fraction of the power leaving the front
/// of `from` that arrives at the front of `to`; the front is where the corners run counter-clockwise. Convex
/// or not, but edges must not cross. Metres, or any one unit. What is behind the other's plane is cut away,
/// so polygons may reach through each other's planes; they may touch along edges and at corners, where the
/// value is exact as well. (Polygons that cut through each other block themselves; that is not seen to.)
///
/// Double contour integral over the edges, each pair in closed form; `contour_integral` says which case does
/// what. Source: Schröder and Hanrahan 1993, "On the form factor between two polygons". Absolute error below
/// 1e-11 for polygons of ordinary shape, times (perimeter² / area) / 16 for thin ones; far pairs keep ten
/// digits. Errors: invalid_input as in check_polygon. Thread-safety: pure.
double polygon_form_factor(std::span<const Vec3d> from, std::span<const Vec3d> to);

/// A_from F_from,to, m²: the same both ways. Areas and errors as above.
double polygon_exchange_area(std::span<const Vec3d> from, std::span<const Vec3d> to);

}  // namespace afterglow
