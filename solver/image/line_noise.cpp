#include "solver/image/line_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/base/sampling.h"
#include "solver/image/surface_light.h"

namespace afterglow {

namespace {

constexpr std::size_t looks = 4096;
constexpr std::size_t looks_per_chunk = 64;

}  // namespace

double line_noise(const Picture& picture, const CameraView& view, const LitWorld& lit,
                  std::uint64_t& rays_traced, const Context& context) {
    struct Look {
        double noise = 0, light = 0;  // squares, summed over channels
    };
    const SobolPoints points(looks);
    std::vector<Look> seen(looks);
    context.for_chunks(looks, looks_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Sample4 s = points.at(k, 0);
            const float x = s[0] * static_cast<float>(view.width), y = s[1] * static_cast<float>(view.height);
            const Ray ray = view.ray(x, y);
            const Hit hit = lit.caster->nearest(ray, Scope::everything);
            if (hit.body == no_index) continue;
            const Material& material =
                lit.materials[lit.world->bodies[hit.body].triangles[hit.triangle].material];
            if (max_channel(emitted_by(material, hit.side)) > 0) continue;
            const Rgb noise =
                reflectance_at(*lit.world, material, hit) / pi * interpolated_irradiance(lit, ray, hit);
            const Rgb& light = picture.at(std::min(static_cast<int>(x), view.width - 1),
                                          std::min(static_cast<int>(y), view.height - 1));
            seen[k] = {glm::dot(noise, noise), glm::dot(light, light)};
        }
    });
    rays_traced += looks;
    double noise = 0, light = 0;
    for (const Look& look : seen) {
        noise += look.noise;
        light += look.light;
    }
    return light > 0 ? std::sqrt(noise / light) : 0;
}

}  // namespace afterglow
