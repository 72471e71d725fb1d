#pragma once

#include <algorithm>

#include "solver/base/math.h"

namespace afterglow {

/// Area of a triangle, in double precision so that neither tiny nor huge ones overflow.
inline double area(const Vec3& a, const Vec3& b, const Vec3& c) {
    return 0.5 * glm::length(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)));
}

/// False for triangles whose corners lie on a line as far as single precision can tell: their normal would
/// be noise.
inline bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto squared = [](const Vec3& edge) { return glm::dot(glm::dvec3(edge), glm::dvec3(edge)); };
    const double longest = std::max({squared(b - a), squared(c - b), squared(a - c)});
    return area(a, b, c) > 1e-7 * longest;
}

}  // namespace afterglow
