#pragma once

#include <optional>
#include <utility>

#include "solver/base/math.h"

namespace afterglow {

/// A flat rectangle that shines on the side of edge_u × edge_v.
struct RectangleLight {
    Vec3 corner{0};
    Vec3 edge_u{0}, edge_v{0};  ///< metres, at right angles
};

/// A point of a rectangle as seen from somewhere.
struct RectanglePoint {
    Vec3 position{0};
    float solid_angle = 0;  ///< what the point stands for, steradians; 0 from behind or edge-on
};

/// A point of a rectangle for (s, t) in [0,1)², for a point of a surface with a unit normal: nearly in
/// proportion to what each place gives there. The mean of f · solid_angle is the integral of f over the
/// rectangle's solid angle. Thread-safety: pure.
RectanglePoint point_for(const RectangleLight& light, const Vec3& from, const Vec3& normal, float s, float t);

/// A rectangle as one point sees it: what all points that are chosen from there share. Thread-safety: const
/// after construction; the rectangle must outlive it.
class RectangleView {
  public:
    RectangleView(const RectangleLight& light, const Vec3& from);

    /// Squared distance to the centre, m², up to which points are chosen in solid angle.
    [[nodiscard]] static float near_squared(const RectangleLight& light);
    /// A point for (s, t) in [0,1)²: uniform in solid angle where the rectangle is near (then `solid_angle`
    /// is the whole rectangle's), uniform in area where it is so far that the two hardly differ (then it is
    /// area · cosine / distance²). The mean of f · solid_angle is as for `point_for`. Source: Ureña, Fajardo
    /// and King 2013, "An area-preserving parametrization for spherical rectangles".
    [[nodiscard]] RectanglePoint at(float s, float t) const;
    /// Whether points are chosen in solid angle.
    [[nodiscard]] bool is_near() const { return near_.has_value(); }

  private:
    /// The rectangle in its own frame around the viewpoint, in double: angles at near corners differ by
    /// little.
    struct Spherical {
        double x0, x1, y0, y1, z;  // z < 0
        double b0, b1, k, solid_angle;

        Spherical(double left, double right, double low, double high, double depth);
        /// (x, y) on the rectangle's plane.
        [[nodiscard]] std::pair<double, double> at(double s, double t) const;
    };
    [[nodiscard]] RectanglePoint by_area(float s, float t) const;

    const RectangleLight* light_;
    Vec3 from_;
    Vec3 normal_area_;
    Vec3 x_axis_, y_axis_;
    bool in_front_ = false;
    std::optional<Spherical> near_;  // far away: none
};

}  // namespace afterglow
