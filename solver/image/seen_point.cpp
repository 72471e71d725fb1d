#include "solver/image/seen_point.h"

#include "solver/image/surface_light.h"

namespace afterglow {

SeenPoint look_at(const LitWorld& lit, const Ray& ray, const Hit& hit) {
    SeenPoint seen;
    if (hit.body == no_index) {
        seen.emitted = lit.world->background;
        return seen;
    }
    const Material& material = lit.materials[lit.world->bodies[hit.body].triangles[hit.triangle].material];
    const Index surface = lit.mesh->surfaces.of_triangle[hit.body][hit.triangle];
    seen.surface = 2 * surface + static_cast<Index>(hit.side);
    seen.emitted = emitted_by(material, hit.side);
    seen.reflectance = reflectance_at(*lit.world, material, hit);
    if (!seen.takes_light()) return seen;

    const Pose& pose = lit.caster->pose(hit.body);
    const Vec3 at = ray.origin + hit.distance * ray.direction;
    const Vec3 in_body = hit.body == furniture ? at : glm::conjugate(pose.rotation) * (at - pose.translation);
    const Vec3 in_direction =
        hit.body == furniture ? ray.direction : glm::conjugate(pose.rotation) * ray.direction;
    const bool slipped = lit.mesh->slipped(surface, hit.side, in_body, in_direction);
    if (!slipped) seen.stencil = lit.interpolation->at(hit.body, hit.triangle, hit.side, in_body);
    seen.normal = shading_normal(lit, hit);
    // Where the ray slipped past something, the light is that of the side it came from.
    seen.position = slipped ? pose.point(lit.mesh->just_before(surface, in_body, in_direction))
                            : at + lit.lift_m * normal_at(*lit.world, *lit.caster, hit);
    return seen;
}

Vec3 shading_normal(const LitWorld& lit, const Hit& hit) {
    const float sign = hit.side == Side::front ? 1.0F : -1.0F;
    return lit.caster->pose(hit.body).direction(sign * lit.normals->at(hit.body, hit.triangle, hit.u, hit.v));
}

}  // namespace afterglow
