#include "solver/image/surface_light.h"

namespace afterglow {

Rgb reflectance_at(const World& world, const Material& material, const Hit& hit) {
    if (material.texture == no_index) return material.reflectance;
    const Body& body = world.bodies[hit.body];
    const auto& v = body.triangles[hit.triangle].vertices;
    const Vec2 uv = (1 - hit.u - hit.v) * body.texture_coordinates[v[0]] +
                    hit.u * body.texture_coordinates[v[1]] + hit.v * body.texture_coordinates[v[2]];
    return material.reflectance * world.textures[material.texture].at(uv);
}

Rgb emitted_by(const Material& material, Side side) {
    const bool shines = side == Side::front || material.shines == Material::Shines::both;
    return shines ? material.emission : Rgb(0);
}

Vec3 normal_at(const World& world, const RayCaster& placed, const Hit& hit) {
    const Vec3 front = glm::normalize(doubled_area_normal(world.bodies[hit.body], hit.triangle));
    const Vec3 normal = hit.side == Side::front ? front : -front;
    return hit.body == furniture ? normal : placed.pose(hit.body).direction(normal);
}

}  // namespace afterglow
