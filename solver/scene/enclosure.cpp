#include "solver/scene/enclosure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace afterglow {

namespace {

constexpr std::size_t max_tests = 64'000'000;

/// Directions spread evenly over the sphere. Source: González 2010, "Measurement of areas on a sphere using
/// Fibonacci and latitude–longitude lattices".
std::vector<Vec3> spread_directions(std::size_t count) {
    constexpr double golden_angle = 2.399963229728653;
    std::vector<Vec3> out;
    for (std::size_t k = 0; k < count; ++k) {
        const double z = 1 - (2 * static_cast<double>(k) + 1) / static_cast<double>(count);
        const double r = std::sqrt(1 - z * z);
        const double angle = golden_angle * static_cast<double>(k);
        out.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    return out;
}

/// Source: Möller and Trumbore 1997. Edges belong to both triangles that share one, so that no line slips
/// through between them.
bool hits(const Vec3& from, const Vec3& direction, const std::array<Vec3, 3>& corners) {
    constexpr float edge = 1e-5F;
    const Vec3 u = corners[1] - corners[0];
    const Vec3 v = corners[2] - corners[0];
    const Vec3 p = glm::cross(direction, v);
    const float determinant = glm::dot(u, p);
    if (determinant == 0.0F) return false;
    const Vec3 to = (from - corners[0]) / determinant;
    const float a = glm::dot(to, p);
    const Vec3 q = glm::cross(to, u);
    const float b = glm::dot(direction, q);
    return a >= -edge && b >= -edge && a + b <= 1 + edge && glm::dot(v, q) > 0;
}

}  // namespace

bool is_enclosed(const World& world, const Vec3& from) {
    std::size_t triangles = 0;
    for (const Body& body : world.bodies) triangles += body.triangles.size();
    if (triangles == 0) return false;
    auto open = spread_directions(std::clamp<std::size_t>(max_tests / triangles, 8, 64));
    for (const Body& body : world.bodies) {
        const Pose pose = body.path.at(0);
        for (const Triangle& triangle : body.triangles) {
            std::array<Vec3, 3> corners{};
            for (std::size_t k = 0; k < 3; ++k) corners[k] = pose.point(body.positions[triangle.vertices[k]]);
            open.erase(std::remove_if(open.begin(), open.end(),
                                      [&](const Vec3& d) { return hits(from, d, corners); }),
                       open.end());
            if (open.empty()) return true;
        }
    }
    return false;
}

}  // namespace afterglow
