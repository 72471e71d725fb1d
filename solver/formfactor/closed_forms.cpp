#include "solver/formfactor/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "solver/base/error.h"

namespace afterglow {

namespace {

void check_lengths(std::initializer_list<double> lengths, const char* place) {
    for (const double length : lengths)
        if (!(length > 0) || !std::isfinite(length))
            throw Error(ErrorKind::invalid_input, place, "a length is not a finite number above 0");
}

/// The angle between two vectors, along the normal of the plane they span; 0 where they span none.
Vec3d angle_vector(const Vec3d& a, const Vec3d& b) {
    const Vec3d across = glm::cross(a, b);
    const double length = glm::length(across);
    if (length == 0) return Vec3d(0);
    // atan2 keeps its digits for small and for straight angles, where acos loses half of them.
    return (std::atan2(length, glm::dot(a, b)) / length) * across;
}

}  // namespace

double parallel_rectangles(double width, double height, double gap) {
    check_lengths({width, height, gap}, "parallel_rectangles");
    const double x = width / gap, y = height / gap;
    const double with_x = std::sqrt(1 + x * x), with_y = std::sqrt(1 + y * y);
    // ln √((1+x²)(1+y²)/(1+x²+y²)), written so that small rectangles keep their digits.
    const double logarithm = 0.5 * std::log1p(x * x * y * y / (1 + x * x + y * y));
    const double angles = x * with_y * std::atan(x / with_y) + y * with_x * std::atan(y / with_x) -
                          x * std::atan(x) - y * std::atan(y);
    return 2 / (pi_d * x * y) * (logarithm + angles);
}

double perpendicular_rectangles(double common_edge, double depth, double height) {
    check_lengths({common_edge, depth, height}, "perpendicular_rectangles");
    const double w = depth / common_edge, h = height / common_edge;
    const double ww = w * w, hh = h * h, both = std::sqrt(ww + hh);
    const double angles = w * std::atan(1 / w) + h * std::atan(1 / h) - both * std::atan(1 / both);
    const double one = std::log((1 + ww) * (1 + hh) / (1 + ww + hh));
    const double two = ww * std::log(ww * (1 + ww + hh) / ((1 + ww) * (ww + hh)));
    const double three = hh * std::log(hh * (1 + ww + hh) / ((1 + hh) * (ww + hh)));
    return (angles + 0.25 * (one + two + three)) / (pi_d * w);
}

double point_to_polygon(const PointReceiver& from, std::span<const Vec3d> polygon) {
    check_polygon(polygon, "point_to_polygon");
    if (plane_of(polygon).height(from.point) <= 0) return 0;
    std::vector<Vec3d> above;
    clip_to_front(polygon, {from.normal, glm::dot(from.normal, from.point)}, 0, above);
    Vec3d sum(0);
    for (std::size_t k = 0; k < above.size(); ++k)
        sum += angle_vector(above[(k + 1) % above.size()] - from.point, above[k] - from.point);
    return std::clamp(glm::dot(sum, from.normal) / (2 * pi_d), 0.0, 1.0);
}

double point_to_disc(double radius, double distance, double offset) {
    check_lengths({radius, distance}, "point_to_disc");
    if (!(offset >= 0) || !std::isfinite(offset))
        throw Error(ErrorKind::invalid_input, "point_to_disc", "the offset is not a finite number from 0 on");
    const double rr = radius * radius, hh = distance * distance;
    // Nearest and farthest point of the rim; factored, so that a receiver under a wide rim keeps its digits.
    const double root = std::hypot(offset - radius, distance) * std::hypot(offset + radius, distance);
    const double rest = (offset - radius) * (offset + radius) + hh;
    // ½ (1 − rest / root); for small discs the difference would cancel, so it is multiplied out.
    return rest > 0 ? 2 * rr * hh / (root * (root + rest)) : 0.5 * (1 - rest / root);
}

double coaxial_discs(double radius_from, double radius_to, double gap) {
    check_lengths({radius_from, radius_to, gap}, "coaxial_discs");
    const double from = radius_from / gap, to = radius_to / gap;
    const double x = 1 + from * from + to * to;
    // (x − √(x² − 4 from² to²)) / (2 from²), multiplied out for the same reason.
    return 2 * to * to / (x + std::sqrt(x * x - 4 * from * from * to * to));
}

}  // namespace afterglow
