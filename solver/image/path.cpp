#include "solver/image/path.h"

#include <algorithm>
#include <atomic>

#include "solver/base/error.h"
#include "solver/image/surface_light.h"

namespace afterglow {

namespace {

// Lamps must not block the rays that end on them.
constexpr float short_of_lamp = 1 - 1e-4F;

void check(const PathPictureConfig& config) {
    if (config.samples_per_pixel < 2)
        throw Error(ErrorKind::invalid_input, "samples_per_pixel", "must be 2 or more");
}

/// Whether lamps that are sampled count where the first ray meets them.
enum class LampsMetFirst { count, counted_already };

Rgb radiance_along(const PathScene& scene, const PathConfig& config, Ray ray, LampsMetFirst lamps_met,
                   RandomStream& random, std::uint64_t& rays_traced) {
    Rgb radiance(0), throughput(1);
    for (int bounce = 0; bounce <= config.most_bounces; ++bounce) {
        const PathPoint at = follow(scene, ray, rays_traced);
        // A lamp that the last point sampled has given its light already.
        const bool counts =
            at.light == PathPoint::Light::met || (bounce == 0 && lamps_met == LampsMetFirst::count);
        if (counts) radiance += throughput * at.emitted;
        const float largest = max_channel(at.reflectance);
        if (largest <= 0) return radiance;

        throughput *= at.reflectance;
        LampChoice lamp;
        if (scene.direct != nullptr && !scene.direct->empty())
            lamp = {random.next(), random.next(), random.next()};
        radiance += throughput / pi * sampled_irradiance(scene, at, lamp, rays_traced);
        if (bounce >= config.sure_bounces) {
            if (random.next() >= largest) return radiance;
            throughput /= std::min(largest, 1.0F);
        }
        const float u = random.next(), v = random.next();
        ray = {at.position, Frame(at.normal).to_world(cosine_direction(u, v))};
    }
    return radiance;
}

}  // namespace

PathPoint follow(const PathScene& scene, const Ray& ray, std::uint64_t& rays_traced) {
    ++rays_traced;
    PathPoint point;
    const Hit hit = scene.caster->nearest(ray, Scope::everything);
    if (hit.body == no_index) {
        point.emitted = scene.world->background;
        return point;
    }
    const Triangle& triangle = scene.world->bodies[hit.body].triangles[hit.triangle];
    const Material& material = scene.materials[triangle.material];
    point.emitted = emitted_by(material, hit.side);
    point.reflectance = reflectance_at(*scene.world, material, hit);
    point.normal = normal_at(*scene.world, *scene.caster, hit);
    point.position = ray.origin + hit.distance * ray.direction + scene.lift_m * point.normal;
    if (scene.direct != nullptr && scene.direct->covers(hit)) point.light = PathPoint::Light::sampled;
    return point;
}

Rgb sampled_irradiance(const PathScene& scene, const PathPoint& at, const LampChoice& lamp,
                       std::uint64_t& rays_traced) {
    Rgb sum(0);
    const auto add = [&](const Rgb& irradiance, const Vec3& direction, float distance_m) {
        if (max_channel(irradiance) <= 0) return;
        ++rays_traced;
        const Ray shadow{at.position, direction, distance_m * short_of_lamp};
        if (!scene.caster->occluded(shadow, Scope::everything)) sum += irradiance;
    };
    if (scene.direct != nullptr && !scene.direct->empty()) {
        const LightSample sample = scene.direct->sample(at.position, at.normal, lamp.choice, lamp.s, lamp.t);
        add(sample.irradiance, sample.direction, sample.distance_m);
    }
    for (const LightInPlace& light : scene.lights) {
        const LightAtPoint sample = light_at(light.light, light.pose, at.position, at.normal);
        add(sample.irradiance, sample.direction, sample.distance_m);
    }
    return sum;
}

Rgb path_radiance(const PathScene& scene, const PathConfig& config, const Ray& ray, RandomStream& random,
                  std::uint64_t& rays_traced) {
    // A camera has sampled no lamp.
    return radiance_along(scene, config, ray, LampsMetFirst::count, random, rays_traced);
}

Rgb gathered_radiance(const PathScene& scene, const PathConfig& config, const Ray& ray, RandomStream& random,
                      std::uint64_t& rays_traced) {
    return radiance_along(scene, config, ray, LampsMetFirst::counted_already, random, rays_traced);
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
