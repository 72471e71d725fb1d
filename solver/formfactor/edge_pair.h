#pragma once

#include "solver/formfactor/polygon.h"

namespace afterglow {

/// A straight edge of a contour, metres.
struct ContourEdge {
    Vec3d from{0}, to{0};
};

/// ∫∫ ln r dx · dx′ over two edges, r the distance between x and x′: the terms that Stokes' theorem makes of
/// a form factor between polygons. `tolerance` > 0, m²: the largest error that does harm.
///
/// Which case does what, with σ the sine of the angle between the edges and h the distance of their lines:
/// - at right angles: 0;
/// - far apart (by twice the longer edge): Gauss–Legendre, 10 × 10 points, exact to rounding there;
/// - parallel or on one line, touching or not: elementary closed form;
/// - lines that cross (h = 0), edges that share a corner too: elementary closed form;
/// - skew lines: closed form with dilogarithms. As in Schröder and Hanrahan 1993 the inner integral is
///   elementary and the outer one has dilogarithms; ours is written for the rectangle of the two arc lengths
///   seen from the common perpendicular, so that all arguments stay within the unit disc and no branch has to
///   be followed;
/// - nearly parallel (where that form would lose more than the tolerance to cancellation, about (l/σ)² of
///   rounding): inner integral in closed form, outer one by adaptive Gauss–Kronrod, to the tolerance.
///
/// Thread-safety: pure.
double contour_integral(const ContourEdge& a, const ContourEdge& b, double tolerance);

}  // namespace afterglow
