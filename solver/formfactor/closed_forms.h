#pragma once

#include <span>

#include "solver/formfactor/polygon.h"

// Form factors that are known exactly, without anything in between. Lengths are metres, or any one unit; all
// must be finite and above 0 unless said otherwise. Double precision: relative error about 1e-13, absolute
// error about 1e-15. Errors: invalid_input, naming the function, where a length or polygon breaks these
// rules. Thread-safety: pure functions. Source, unless said otherwise: Howell, "A catalog of radiation heat
// transfer configuration factors" (the configurations' numbers stand with each).

namespace afterglow {

/// Two equal parallel rectangles, edges `width` and `height`, straight opposite each other at `gap` (C-11).
double parallel_rectangles(double width, double height, double gap);

/// From a rectangle of depth `depth` to one at right angles to it of height `height` that shares its edge of
/// length `common_edge` (C-14).
double perpendicular_rectangles(double common_edge, double depth, double height);

/// A small flat receiver.
struct PointReceiver {
    Vec3d point{0};
    Vec3d normal{0, 0, 1};  ///< unit; sees the half-space that it points into
};

/// From a small receiver to the front of a polygon, simple, of any shape; what is below the receiver's
/// horizon does not count, and 0 where the receiver is behind or in the polygon's plane. The front is where
/// the corners run counter-clockwise. Source: Lambert 1760, as in Baum, Rushmeier and Winget 1989.
double point_to_polygon(const PointReceiver& from, std::span<const Vec3d> polygon);

/// From a small receiver to a disc of `radius` in a plane parallel to it at `distance`, whose axis passes the
/// receiver at `offset` ≥ 0 (B-13).
double point_to_disc(double radius, double distance, double offset = 0);

/// From a disc of `radius_from` to a parallel one of `radius_to` on the same axis at `gap` (C-41).
double coaxial_discs(double radius_from, double radius_to, double gap);

}  // namespace afterglow
