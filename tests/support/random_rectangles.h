#pragma once

#include <array>

#include "solver/base/sampling.h"
#include "solver/formfactor/closed_forms.h"
#include "solver/image/rectangle_light.h"

namespace afterglow::testing {

/// Rectangles of .2 to 2.2 metres and points before them, and what these get of each other.
class RandomRectangles {
  public:
    explicit RandomRectangles(std::uint64_t seed) : random_(seed) {}

    /// Any direction.
    Vec3 normal() {
        const Vec3 up = cosine_direction(random_.next(), random_.next());
        return random_.next() < 0.5F ? up : -up;
    }
    RectangleLight rectangle() {
        const Vec3 u = normal(), v = glm::normalize(glm::cross(u, normal()));
        return {3.0F * normal(), (0.2F + 2 * random_.next()) * u, (0.2F + 2 * random_.next()) * v};
    }
    /// Up to two diagonals away, more often near its plane.
    Vec3 point_before(const RectangleLight& light) {
        const float diagonal = glm::length(light.edge_u + light.edge_v);
        const Vec3 up = glm::normalize(glm::cross(light.edge_u, light.edge_v));
        const float height = 2 * diagonal * random_.next() * random_.next();
        return light.corner + (3 * random_.next() - 1) * light.edge_u +
               (3 * random_.next() - 1) * light.edge_v + (0.02F * diagonal + height) * up;
    }
    static double form_factor(const RectangleLight& light, const Vec3& from, const Vec3& normal) {
        const Vec3d corner(light.corner), u(light.edge_u), v(light.edge_v);
        return point_to_polygon({Vec3d(from), Vec3d(normal)},
                                std::array{corner, corner + u, corner + u + v, corner + v});
    }

  private:
    RandomStream random_;
};

/// What a place of a rectangle stands for in a point's irradiance, over π and per W/m² of radiosity.
inline double irradiance_share(const RectanglePoint& place, const Vec3& from, const Vec3& normal) {
    const Vec3d to = Vec3d(place.position) - Vec3d(from);
    const double distance = glm::length(to);
    if (!(distance > 0)) return 0;
    return std::max(0.0, glm::dot(to, Vec3d(normal)) / distance) * static_cast<double>(place.solid_angle) /
           static_cast<double>(pi);
}

}  // namespace afterglow::testing
