#include "tests/support/brute_force.h"

#include <algorithm>
#include <cmath>

namespace afterglow::testing {

namespace {

using Vec3d = glm::dvec3;

struct RayD {
    Vec3d origin, direction;
};

void try_triangle(const Body& body, Index b, Index t, const RayD& ray, double far, Hit& best) {
    const auto& v = body.triangles[t].vertices;
    const Vec3d a(body.positions[v[0]]), ab = Vec3d(body.positions[v[1]]) - a,
                                         ac = Vec3d(body.positions[v[2]]) - a;
    const Vec3d p = glm::cross(ray.direction, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0) return;
    const Vec3d s = ray.origin - a;
    const double u = glm::dot(s, p) / determinant;
    const Vec3d q = glm::cross(s, ab);
    const double w = glm::dot(ray.direction, q) / determinant;
    const double distance = glm::dot(ac, q) / determinant;
    if (u < 0 || w < 0 || u + w > 1 || distance < 0 ||
        distance > std::min(far, static_cast<double>(best.distance)))
        return;
    best.body = b;
    best.triangle = t;
    best.distance = static_cast<float>(distance);
    best.u = static_cast<float>(u);
    best.v = static_cast<float>(w);
    best.side = glm::dot(ray.direction, glm::cross(ab, ac)) < 0 ? Side::front : Side::back;
}

}  // namespace

Hit nearest_by_brute_force(const World& world, std::span<const Pose> poses, const Ray& ray, Scope scope) {
    Hit best;
    for (Index b = 0; b < world.bodies.size(); ++b) {
        const bool is_furniture = b == furniture;
        if ((is_furniture && scope == Scope::actors) || (!is_furniture && scope == Scope::static_geometry))
            continue;
        // Into the body's frame, so that every body is tested where its triangles are.
        const glm::dquat back = glm::conjugate(glm::dquat(poses[b].rotation));
        const RayD local{
            is_furniture ? Vec3d(ray.origin) : back * (Vec3d(ray.origin) - Vec3d(poses[b].translation)),
            is_furniture ? Vec3d(ray.direction) : back * Vec3d(ray.direction)};
        for (Index t = 0; t < world.bodies[b].triangles.size(); ++t)
            try_triangle(world.bodies[b], b, t, local, ray.far, best);
    }
    return best;
}

double distance_from_edge(const Hit& hit) {
    return std::min({hit.u, hit.v, 1 - hit.u - hit.v});
}

}  // namespace afterglow::testing
