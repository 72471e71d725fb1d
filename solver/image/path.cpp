#include "solver/image/path.h"

#include <algorithm>
#include <atomic>

#include "solver/base/error.h"
#include "solver/image/surface_light.h"

namespace afterglow {

namespace {

// Lamps must not block the rays that end on them.
constexpr float short_of_lamp = 1 - 1e-4F;

/// Where a path meets a surface, ready for rays to start.
struct PathPoint {
    Vec3 position{0};  // lifted
    Vec3 normal{0};
};

/// Irradiance, W/m², that the lamps and lights taken by shadow rays give a point.
Rgb irradiance_by_shadow_rays(const PathScene& scene, const PathPoint& at, RandomStream& random,
                              std::uint64_t& rays_traced) {
    Rgb sum(0);
    const auto add = [&](const Rgb& irradiance, const Vec3& direction, float distance_m) {
        if (max_channel(irradiance) <= 0) return;
        ++rays_traced;
        const Ray shadow{at.position, direction, distance_m * short_of_lamp};
        if (!scene.caster->occluded(shadow, Scope::everything)) sum += irradiance;
    };
    if (scene.direct != nullptr && !scene.direct->empty()) {
        const float choice = random.next(), s = random.next(), t = random.next();
        const LightSample sample = scene.direct->sample(at.position, at.normal, choice, s, t);
        add(sample.irradiance, sample.direction, sample.distance_m);
    }
    for (const LightInPlace& light : scene.lights) {
        const LightAtPoint sample = light_at(light.light, light.pose, at.position, at.normal);
        add(sample.irradiance, sample.direction, sample.distance_m);
    }
    return sum;
}

void check(const PathPictureConfig& config) {
    if (config.samples_per_pixel < 2)
        throw Error(ErrorKind::invalid_input, "samples_per_pixel", "must be 2 or more");
}

}  // namespace

Rgb path_radiance(const PathScene& scene, const PathConfig& config, const Ray& camera_ray,
                  RandomStream& random, std::uint64_t& rays_traced) {
    Rgb radiance(0), throughput(1);
    Ray ray = camera_ray;
    for (int bounce = 0; bounce <= config.most_bounces; ++bounce) {
        ++rays_traced;
        const Hit hit = scene.caster->nearest(ray, Scope::everything);
        if (hit.body == no_index) return radiance + throughput * scene.world->background;

        const Triangle& triangle = scene.world->bodies[hit.body].triangles[hit.triangle];
        const Material& material = scene.materials[triangle.material];
        // A lamp that the last point sampled has given its light already; a camera has sampled none.
        if (bounce == 0 || scene.direct == nullptr || !scene.direct->covers(hit))
            radiance += throughput * emitted_by(material, hit.side);
        const Rgb reflectance = reflectance_at(*scene.world, material, hit);
        const float largest = max_channel(reflectance);
        if (largest <= 0) return radiance;

        const Vec3 normal = normal_at(*scene.world, *scene.caster, hit);
        const PathPoint at{ray.origin + hit.distance * ray.direction + scene.lift_m * normal, normal};
        throughput *= reflectance;
        radiance += throughput / pi * irradiance_by_shadow_rays(scene, at, random, rays_traced);
        if (bounce >= config.sure_bounces) {
            if (random.next() >= largest) return radiance;
            throughput /= std::min(largest, 1.0F);
        }
        const float u = random.next(), v = random.next();
        ray = {at.position, Frame(normal).to_world(cosine_direction(u, v))};
    }
    return radiance;
}

PathPixel trace_pixel(const CameraView& view, const PathScene& scene, const PathPictureConfig& config, int x,
                      int y, std::uint64_t& rays_traced) {
    check(config);
    const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(view.width) +
                       static_cast<std::uint64_t>(x);
    const std::uint64_t pixel_seed = mixed(config.seed, pixel);
    // Welford's running mean and sum of squared deviations: no cancellation where the noise is small.
    glm::dvec3 mean(0), squares(0);
    for (int k = 0; k < config.samples_per_pixel; ++k) {
        RandomStream random(mixed(pixel_seed, static_cast<std::uint64_t>(k)));
        const float dx = random.next(), dy = random.next();
        const Ray ray = view.ray(static_cast<float>(x) + dx, static_cast<float>(y) + dy);
        const glm::dvec3 sample(path_radiance(scene, config.path, ray, random, rays_traced));
        const glm::dvec3 before = sample - mean;
        mean += before / static_cast<double>(k + 1);
        squares += before * (sample - mean);
    }
    const double n = config.samples_per_pixel;
    return {Rgb(mean), Rgb(squares / (n * (n - 1)))};
}

PathPicture trace_picture(const CameraView& view, const PathScene& scene, const PathPictureConfig& config,
                          std::uint64_t& rays_traced, const Context& context) {
    check(config);
    PathPicture picture{Picture(view.width, view.height), Picture(view.width, view.height)};
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(static_cast<std::size_t>(view.height), 1, [&](std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t row = begin; row < end; ++row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < view.width; ++x) {
                const PathPixel pixel = trace_pixel(view, scene, config, x, y, count);
                picture.mean.at(x, y) = pixel.mean;
                picture.variance.at(x, y) = pixel.variance;
            }
        }
        traced += count;
    });
    rays_traced += traced;
    return picture;
}

}  // namespace afterglow
