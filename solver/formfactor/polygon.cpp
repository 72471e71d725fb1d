#include "solver/formfactor/polygon.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "solver/base/error.h"

namespace afterglow {

namespace {

constexpr double planar_share = 1e-4;     // of the extent: single-precision scenes are not flatter
constexpr double smallest_area = 1e-12;   // of the extent's square
constexpr double largest_number = 1e100;  // squares and cubes must stay finite

Vec3d mean(std::span<const Vec3d> corners) {
    Vec3d sum(0);
    for (const Vec3d& c : corners) sum += c;
    return sum / static_cast<double>(corners.size());
}

}  // namespace

Vec3d area_vector(std::span<const Vec3d> corners) {
    Vec3d sum(0);
    // Differences from one corner, so that a polygon far from the origin keeps its digits.
    for (std::size_t k = 2; k < corners.size(); ++k)
        sum += glm::cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
    return 0.5 * sum;
}

Plane plane_of(std::span<const Vec3d> corners) {
    const Vec3d normal = glm::normalize(area_vector(corners));
    return {normal, glm::dot(normal, mean(corners))};
}

void clip_to_front(std::span<const Vec3d> corners, const Plane& plane, double tolerance_m,
                   std::vector<Vec3d>& out) {
    out.clear();
    if (corners.empty()) return;
    const auto height_of = [&](const Vec3d& x) {
        const double height = plane.height(x);
        return std::abs(height) <= tolerance_m ? 0.0 : height;
    };
    double before = height_of(corners.back());
    bool any_in_front = false;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3d& from = k == 0 ? corners.back() : corners[k - 1];
        const double here = height_of(corners[k]);
        if ((before > 0 && here < 0) || (before < 0 && here > 0))
            out.push_back(from + (before / (before - here)) * (corners[k] - from));
        if (here >= 0) out.push_back(corners[k]);
        any_in_front |= here > 0;
        before = here;
    }
    if (!any_in_front) out.clear();
}

void check_polygon(std::span<const Vec3d> corners, std::string_view place) {
    const auto fail = [&](const char* message) {
        throw Error(ErrorKind::invalid_input, std::string(place), message);
    };
    if (corners.size() < 3) fail("a polygon needs three corners or more");
    double extent = 0;
    for (const Vec3d& c : corners) {
        for (const double x : {c.x, c.y, c.z})
            if (!(std::abs(x) < largest_number)) fail("a corner of the polygon is not a finite number");
        extent = std::max(extent, glm::length(c - corners[0]));
    }
    if (!(glm::length(area_vector(corners)) > smallest_area * extent * extent))
        fail("the polygon has no area");
    const Plane plane = plane_of(corners);
    for (const Vec3d& c : corners)
        if (std::abs(plane.height(c)) > planar_share * extent)
            fail("the polygon's corners are not in one plane");
}

}  // namespace afterglow
