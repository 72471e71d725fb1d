#include "solver/image/rectangle_light.h"

#include <algorithm>

#include "solver/image/rectangle_choice.h"

namespace afterglow {

namespace {

// Beyond this many diagonals the integrand varies so little over the area that the costlier way gains
// nothing.
constexpr float far_diagonals = 1.5F;

/// Of lengths in metres, which neither overflow nor vanish: std::hypot guards against that and is slow.
double hypotenuse(double a, double b) {
    return std::sqrt(a * a + b * b);
}

}  // namespace

RectangleView::Spherical::Spherical(double left, double right, double low, double high, double depth)
    : x0(left), x1(right), y0(low), y1(high), z(depth) {
    const auto unit_z = [&](double a, double b) { return -b / hypotenuse(a, b); };
    // Normals of the four planes through the viewpoint and an edge; only their z matter.
    const double n0 = unit_z(z, y0), n1 = -unit_z(z, x1), n2 = -unit_z(z, y1), n3 = unit_z(z, x0);
    const double g0 = std::acos(std::clamp(-n0 * n1, -1.0, 1.0));
    const double g1 = std::acos(std::clamp(-n1 * n2, -1.0, 1.0));
    const double g2 = std::acos(std::clamp(-n2 * n3, -1.0, 1.0));
    const double g3 = std::acos(std::clamp(-n3 * n0, -1.0, 1.0));
    b0 = n0;
    b1 = n2;
    k = 2 * static_cast<double>(pi) - g2 - g3;
    solid_angle = g0 + g1 - k;
}

std::pair<double, double> RectangleView::Spherical::at(double s, double t) const {
    const double angle = s * solid_angle + k;
    const double f = (std::cos(angle) * b0 - b1) / std::sin(angle);
    const double cu = std::clamp(std::copysign(1.0, f) / hypotenuse(f, b0), -1.0, 1.0);
    const double x = std::clamp(-(cu * z) / std::sqrt(std::max(1e-300, 1 - cu * cu)), x0, x1);
    const double d = hypotenuse(x, z);
    const double h0 = y0 / hypotenuse(d, y0), h1 = y1 / hypotenuse(d, y1);
    const double h = h0 + t * (h1 - h0);
    const double y = h * h < 1 - 1e-12 ? h * d / std::sqrt(1 - h * h) : y1;
    return {x, std::clamp(y, y0, y1)};
}

RectangleView::RectangleView(const RectangleLight& light, const Vec3& from)
    : light_(&light), from_(from), normal_area_(glm::cross(light.edge_u, light.edge_v)) {
    const float length_u = glm::length(light.edge_u), length_v = glm::length(light.edge_v);
    x_axis_ = light.edge_u / length_u;
    y_axis_ = light.edge_v / length_v;
    const Vec3 to_corner = light.corner - from;
    const float height = -glm::dot(to_corner, normal_area_) / (length_u * length_v);
    in_front_ = height > 0;
    if (!in_front_) return;
    const Vec3 to_centre = to_corner + 0.5F * (light.edge_u + light.edge_v);
    if (glm::dot(to_centre, to_centre) > near_squared(light)) return;

    const double x0 = static_cast<double>(glm::dot(to_corner, x_axis_));
    const double y0 = static_cast<double>(glm::dot(to_corner, y_axis_));
    const Spherical seen(x0, x0 + static_cast<double>(length_u), y0, y0 + static_cast<double>(length_v),
                         -static_cast<double>(height));
    if (seen.solid_angle > 1e-9) near_ = seen;
}

float RectangleView::near_squared(const RectangleLight& light) {
    return far_diagonals * far_diagonals *
           (glm::dot(light.edge_u, light.edge_u) + glm::dot(light.edge_v, light.edge_v));
}

RectanglePoint RectangleView::by_area(float s, float t) const {
    RectanglePoint out{light_->corner + s * light_->edge_u + t * light_->edge_v, 0};
    const Vec3 back = from_ - out.position;
    const float squared = glm::dot(back, back);
    if (squared > 0)
        out.solid_angle = std::max(0.0F, glm::dot(normal_area_, back)) / (squared * std::sqrt(squared));
    return out;
}

RectanglePoint RectangleView::at(float s, float t) const {
    if (!in_front_) return {light_->corner, 0};
    if (!near_) return by_area(s, t);
    const auto [x, y] = near_->at(static_cast<double>(s), static_cast<double>(t));
    return {light_->corner + static_cast<float>(x - near_->x0) * x_axis_ +
                static_cast<float>(y - near_->y0) * y_axis_,
            static_cast<float>(near_->solid_angle)};
}

RectanglePoint point_for(const RectangleLight& light, const Vec3& from, const Vec3& normal, float s,
                         float t) {
    const RectangleAxes axes(light);
    const RectangleSight sight = sight_of(light, axes, from, normal);
    const RectangleView view(light, from);
    const BentPlace bent =
        bend(s, t, view.is_near() ? corner_cosines(sight, axes) : corner_gains(sight, axes));
    RectanglePoint out = view.at(bent.s, bent.t);
    out.solid_angle /= bent.density;
    return out;
}

}  // namespace afterglow
