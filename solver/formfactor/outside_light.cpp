#include "solver/formfactor/outside_light.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace afterglow {

namespace {

constexpr std::size_t points_per_patch = 8;

/// Smooth from the inner to the outer cone, as KHR_lights_punctual defines it.
float cone_share(const Light& light, float cosine) {
    const float inner = std::cos(light.inner_cone_angle), outer = std::cos(light.outer_cone_angle);
    const float share = std::clamp((cosine - outer) / std::max(0.001F, inner - outer), 0.0F, 1.0F);
    return share * share;
}

}  // namespace

LightAtPoint light_at(const Light& light, const Pose& pose, const Vec3& point, const Vec3& normal) {
    const Vec3 forward = pose.direction(Vec3(0, 0, -1));
    LightAtPoint out;
    if (light.kind == Light::Kind::directional) {
        out.direction = -forward;
        out.distance_m = std::numeric_limits<float>::infinity();
        out.irradiance = light.intensity * std::max(0.0F, glm::dot(normal, out.direction));
        return out;
    }
    const Vec3 across = pose.translation - point;
    out.distance_m = glm::length(across);
    if (!(out.distance_m > 0)) return out;
    out.direction = across / out.distance_m;
    const float share =
        light.kind == Light::Kind::spot ? cone_share(light, glm::dot(-out.direction, forward)) : 1.0F;
    const float cosine = std::max(0.0F, glm::dot(normal, out.direction));
    out.irradiance = light.intensity * (share * cosine / (out.distance_m * out.distance_m));
    return out;
}

std::vector<LightInPlace> lights_at(const World& world, double time_s) {
    std::vector<LightInPlace> lights;
    for (const PlacedLight& light : world.lights) lights.push_back({light.light, light.path.at(time_s)});
    return lights;
}

std::vector<Rgb> sky_irradiance(const World& world, std::span<const float> sky) {
    std::vector<Rgb> irradiance(sky.size());
    for (std::size_t p = 0; p < irradiance.size(); ++p) irradiance[p] = pi * sky[p] * world.background;
    return irradiance;
}

std::vector<Rgb> light_irradiance(std::span<const LightInPlace> lights, const PatchMesh& mesh,
                                  const SightLines& lines, const RayCaster& placed,
                                  std::span<const float> valid_share, std::uint64_t& rays_traced,
                                  const Context& context) {
    std::vector<Rgb> irradiance(mesh.size(), Rgb(0));
    if (lights.empty()) return irradiance;
    const SobolPoints points(points_per_patch);
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(mesh.size(), 64, [&](std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const auto p = static_cast<Index>(i);
            if (valid_share[p] <= 0) continue;
            const Pose& pose = placed.pose(mesh.body[p]);
            Rgb sum(0);
            for (std::size_t k = 0; k < points_per_patch; ++k) {
                const Sample4 sample = points.at(k, p);
                PatchPoint at = mesh.point_on(p, sample[0], sample[1]);
                if (mesh.body[p] != furniture) at = {pose.point(at.position), pose.direction(at.normal)};
                const Vec3 origin = at.position + lines.lift_m() * at.normal;
                for (const LightInPlace& placed_light : lights) {
                    const LightAtPoint light =
                        light_at(placed_light.light, placed_light.pose, origin, at.normal);
                    if (max_channel(light.irradiance) <= 0) continue;
                    ++count;
                    if (!placed.occluded({origin, light.direction, light.distance_m}, Scope::everything))
                        sum += light.irradiance;
                }
            }
            // Buried points are in the dark; the others stand for the whole patch.
            irradiance[p] += sum / (static_cast<float>(points_per_patch) * valid_share[p]);
        }
        traced += count;
    });
    rays_traced += traced;
    return irradiance;
}

}  // namespace afterglow
