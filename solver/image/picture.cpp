#include "solver/image/picture.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "solver/base/sampling.h"
#include "solver/image/surface_light.h"

namespace afterglow {

namespace {

constexpr std::size_t lanes = 16;

/// What a camera ray meets, as far as light is concerned.
struct SeenPoint {
    Rgb radiance{0};     ///< without the light that is taken point by point
    Rgb reflectance{0};  ///< 0: no light need be taken
    Vec3 position{0};    ///< lifted off the surface, world
    Vec3 normal{0};      ///< unit, on the side that is seen
};

SeenPoint look_at(const LitWorld& lit, const Ray& ray, const Hit& hit) {
    SeenPoint seen;
    if (hit.body == no_index) {
        seen.radiance = lit.world->background;
        return seen;
    }
    const Body& body = lit.world->bodies[hit.body];
    const Triangle& triangle = body.triangles[hit.triangle];
    const Material& material = lit.materials[triangle.material];
    seen.radiance = emitted_by(material, hit.side);
    seen.reflectance = reflectance_at(*lit.world, material, hit);
    if (max_channel(seen.reflectance) <= 0) return seen;

    const Pose& pose = lit.caster->pose(hit.body);
    const Vec3 at = ray.origin + hit.distance * ray.direction;
    const Vec3 in_body = hit.body == furniture ? at : glm::conjugate(pose.rotation) * (at - pose.translation);
    const Stencil stencil = lit.interpolation->at(hit.body, hit.triangle, hit.side, in_body);
    seen.radiance += seen.reflectance / pi * Interpolation::value(stencil, lit.irradiance, lit.confidence);

    seen.normal = normal_at(*lit.world, *lit.caster, hit);
    seen.position = at + lit.lift_m * seen.normal;
    return seen;
}

/// Renders packets of sixteen neighbouring pixels of a row.
class PacketRenderer {
  public:
    PacketRenderer(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                   const SobolPoints& camera_points, const SobolPoints& light_points)
        : view_(view), lit_(lit), config_(config), camera_(camera_points), light_(light_points) {}

    /// Adds sample k of the pixels from (x0, y) on.
    void add_sample(int x0, int y, std::size_t k, Picture& picture) {
        trace_camera_rays(x0, y, k);
        if (lit_.direct != nullptr && !lit_.direct->empty()) add_lamps(k);
        for (std::size_t l = 0; l < lit_.lights.size(); ++l) add_light(lit_.lights[l]);
        for (std::size_t lane = 0; lane < count_; ++lane)
            picture.at(x0 + static_cast<int>(lane), y) += seen_[lane].radiance;
    }
    [[nodiscard]] std::uint64_t rays_traced() const { return rays_traced_; }

  private:
    void trace_camera_rays(int x0, int y, std::size_t k) {
        RayPacket rays;
        count_ = static_cast<std::size_t>(std::min(static_cast<int>(lanes), view_.width - x0));
        rays.count = static_cast<Index>(count_);
        for (std::size_t lane = 0; lane < count_; ++lane) {
            const int x = x0 + static_cast<int>(lane);
            pixel_[lane] = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(view_.width) +
                           static_cast<std::uint64_t>(x);
            const Sample4 s = camera_.at(k, mixed(config_.seed, pixel_[lane]));
            rays.set(lane, view_.ray(static_cast<float>(x) + s[0], static_cast<float>(y) + s[1]));
        }
        HitPacket hits;
        lit_.caster->nearest(rays, Scope::everything, hits);
        rays_traced_ += count_;
        for (std::size_t lane = 0; lane < count_; ++lane)
            seen_[lane] = look_at(lit_, rays.ray(lane), hits[lane]);
    }

    void add_lamps(std::size_t k) {
        const auto samples = static_cast<std::size_t>(config_.light_samples_per_point);
        for (std::size_t i = 0; i < samples; ++i) {
            trace_shadows(1 / static_cast<float>(samples), [&](std::size_t lane) {
                const Sample4 s = light_.at(k * samples + i, mixed(config_.seed + 1, pixel_[lane]));
                return lit_.direct->sample(seen_[lane].position, seen_[lane].normal, s[2], s[0], s[1]);
            });
        }
    }

    void add_light(const LightInPlace& light) {
        trace_shadows(1, [&](std::size_t lane) {
            const LightAtPoint at =
                light_at(light.light, light.pose, seen_[lane].position, seen_[lane].normal);
            return LightSample{at.irradiance, at.direction, at.distance_m};
        });
    }

    /// Adds `share` of what each lane's sample gives where nothing stands between.
    template <class SampleOf>
    void trace_shadows(float share, const SampleOf& sample_of) {
        RayPacket rays;
        rays.count = static_cast<Index>(count_);
        std::array<Rgb, lanes> gain;
        Index alive = 0;
        for (std::size_t lane = 0; lane < count_; ++lane) {
            SeenPoint& seen = seen_[lane];
            const LightSample sample = max_channel(seen.reflectance) > 0 ? sample_of(lane) : LightSample{};
            gain[lane] = share / pi * seen.reflectance * sample.irradiance;
            const bool lit = max_channel(gain[lane]) > 0;
            // A ray that ends where it starts is switched off; lamps themselves must not block.
            const float far = lit ? sample.distance_m * (1 - 1e-4F) : 0.0F;
            rays.set(lane, {seen.position, lit ? sample.direction : Vec3(0, 0, 1), far});
            alive += lit ? 1U : 0U;
        }
        if (alive == 0) return;
        rays_traced_ += alive;
        const std::uint32_t blocked = lit_.caster->occluded(rays, Scope::everything);
        for (std::size_t lane = 0; lane < count_; ++lane)
            if (((blocked >> lane) & 1U) == 0) seen_[lane].radiance += gain[lane];
    }

    const CameraView& view_;
    const LitWorld& lit_;
    const PictureConfig& config_;
    const SobolPoints& camera_;
    const SobolPoints& light_;
    std::size_t count_ = 0;
    std::array<std::uint64_t, lanes> pixel_{};
    std::array<SeenPoint, lanes> seen_;
    std::uint64_t rays_traced_ = 0;
};

}  // namespace

Picture render_picture(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                       std::uint64_t& rays_traced, const Context& context) {
    Picture picture(view.width, view.height);
    const auto samples = static_cast<std::size_t>(config.samples_per_pixel);
    const SobolPoints camera_points(samples);
    const SobolPoints light_points(samples * static_cast<std::size_t>(config.light_samples_per_point));
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(static_cast<std::size_t>(view.height), 4, [&](std::size_t begin, std::size_t end) {
        PacketRenderer renderer(view, lit, config, camera_points, light_points);
        for (std::size_t row = begin; row < end; ++row) {
            const int y = static_cast<int>(row);
            for (int x0 = 0; x0 < view.width; x0 += static_cast<int>(lanes))
                for (std::size_t k = 0; k < samples; ++k) renderer.add_sample(x0, y, k, picture);
            for (int x = 0; x < view.width; ++x) picture.at(x, y) /= static_cast<float>(samples);
        }
        traced += renderer.rays_traced();
    });
    rays_traced += traced;
    return picture;
}

}  // namespace afterglow
