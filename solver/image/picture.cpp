#include "solver/image/picture.h"

#include <algorithm>

#include "solver/base/sampling.h"

namespace afterglow {

namespace {

Rgb reflectance_at(const LitWorld& lit, const Hit& hit, const Material& material) {
    if (material.texture == no_index) return material.reflectance;
    const Body& body = lit.world->bodies[hit.body];
    const auto& v = body.triangles[hit.triangle].vertices;
    const Vec2 uv = (1 - hit.u - hit.v) * body.texture_coordinates[v[0]] +
                    hit.u * body.texture_coordinates[v[1]] + hit.v * body.texture_coordinates[v[2]];
    return material.reflectance * lit.world->textures[material.texture].at(uv);
}

Rgb radiance_of(const LitWorld& lit, const Ray& ray, const Hit& hit) {
    if (hit.body == no_index) return lit.world->background;
    const Material& material = lit.materials[lit.world->bodies[hit.body].triangles[hit.triangle].material];
    Rgb radiance(0);
    if (hit.side == Side::front || material.shines == Material::Shines::both) radiance = material.emission;
    const Rgb reflectance = reflectance_at(lit, hit, material);
    if (max_channel(reflectance) <= 0) return radiance;
    const Pose& pose = lit.caster->pose(hit.body);
    Vec3 at = ray.origin + hit.distance * ray.direction;
    if (hit.body != furniture) at = glm::conjugate(pose.rotation) * (at - pose.translation);
    const Stencil stencil = lit.interpolation->at(hit.body, hit.triangle, hit.side, at);
    return radiance + reflectance / pi * Interpolation::value(stencil, lit.irradiance, lit.confidence);
}

}  // namespace

Picture render_picture(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                       std::uint64_t& rays_traced, const Context& context) {
    Picture picture(view.width, view.height);
    const auto samples = static_cast<std::size_t>(config.samples_per_pixel);
    const SobolPoints points(samples);
    // Sixteen pixels of a row are traced together.
    context.for_chunks(static_cast<std::size_t>(view.height), 4, [&](std::size_t begin, std::size_t end) {
        RayPacket rays;
        HitPacket hits;
        for (std::size_t row = begin; row < end; ++row) {
            const int y = static_cast<int>(row);
            for (int x0 = 0; x0 < view.width; x0 += 16) {
                rays.count = static_cast<Index>(std::min(16, view.width - x0));
                for (std::size_t k = 0; k < samples; ++k) {
                    for (std::size_t lane = 0; lane < rays.count; ++lane) {
                        const int x = x0 + static_cast<int>(lane);
                        const auto pixel =
                            row * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(x);
                        const Sample4 s = points.at(k, mixed(config.seed, pixel));
                        rays.set(lane, view.ray(static_cast<float>(x) + s[0], static_cast<float>(y) + s[1]));
                    }
                    lit.caster->nearest(rays, Scope::everything, hits);
                    for (std::size_t lane = 0; lane < rays.count; ++lane)
                        picture.at(x0 + static_cast<int>(lane), y) +=
                            radiance_of(lit, rays.ray(lane), hits[lane]);
                }
            }
            for (int x = 0; x < view.width; ++x) picture.at(x, y) /= static_cast<float>(samples);
        }
    });
    rays_traced += picture.pixels.size() * samples;
    return picture;
}

}  // namespace afterglow
