#include "solver/image/picture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "solver/base/sampling.h"
#include "solver/image/surface_light.h"

namespace afterglow {

namespace {

constexpr std::size_t lanes = 16;

/// What a camera ray meets, as far as light is concerned.
struct SeenPoint {
    Rgb radiance{0};           ///< without the light that is taken point by point
    Rgb reflectance{0};        ///< 0: no light need be taken
    Vec3 position{0};          ///< lifted off the surface, world
    Vec3 normal{0};            ///< unit, on the side that is seen
    Index surface = no_index;  ///< twice its number, and its side; nothing: no_index
};

SeenPoint look_at(const LitWorld& lit, const Ray& ray, const Hit& hit) {
    SeenPoint seen;
    if (hit.body == no_index) {
        seen.radiance = lit.world->background;
        return seen;
    }
    const Material& material = lit.materials[lit.world->bodies[hit.body].triangles[hit.triangle].material];
    const Index surface = lit.mesh->surfaces.of_triangle[hit.body][hit.triangle];
    seen.surface = 2 * surface + static_cast<Index>(hit.side);
    seen.radiance = emitted_by(material, hit.side);
    seen.reflectance = reflectance_at(*lit.world, material, hit);
    if (max_channel(seen.reflectance) <= 0) return seen;

    const Pose& pose = lit.caster->pose(hit.body);
    const Vec3 at = ray.origin + hit.distance * ray.direction;
    const Vec3 in_body = hit.body == furniture ? at : glm::conjugate(pose.rotation) * (at - pose.translation);
    const Vec3 in_direction =
        hit.body == furniture ? ray.direction : glm::conjugate(pose.rotation) * ray.direction;
    const bool slipped = lit.mesh->slipped(surface, hit.side, in_body, in_direction);
    if (!slipped) seen.radiance += seen.reflectance / pi * interpolated_irradiance(lit, ray, hit);

    const float sign = hit.side == Side::front ? 1.0F : -1.0F;
    seen.normal = pose.direction(sign * lit.normals->at(hit.body, hit.triangle, hit.u, hit.v));
    // Where the ray slipped past something, the light is that of the side it came from.
    seen.position = slipped ? pose.point(lit.mesh->just_before(surface, in_body, in_direction))
                            : at + lit.lift_m * normal_at(*lit.world, *lit.caster, hit);
    return seen;
}

float luminance(const Rgb& c) {
    return 0.2126F * c.r + 0.7152F * c.g + 0.0722F * c.b;
}

/// What the samples of a pixel have given so far.
struct Tally {
    Rgb sum{0};
    float squares = 0;  ///< of luminance
    int count = 0;
    Index surface = no_index;
    bool sees_several = false;

    void add(const SeenPoint& seen) {
        sum += seen.radiance;
        squares += luminance(seen.radiance) * luminance(seen.radiance);
        if (count > 0 && seen.surface != surface) sees_several = true;
        surface = seen.surface;
        ++count;
    }
    [[nodiscard]] bool is_noisy(float noise) const {
        if (sees_several) return true;
        const auto n = static_cast<float>(count);
        const float mean = luminance(sum) / n;
        const float variance = std::max(0.0F, squares / n - mean * mean) / std::max(1.0F, n - 1);
        return variance > noise * noise * mean * mean;
    }
};

/// Which sample of which pixel a lane takes.
struct LaneSample {
    int x = 0, y = 0;
    std::size_t k = 0;
};

/// Takes sixteen samples at a time: of neighbouring pixels, or of one.
class PacketRenderer {
  public:
    PacketRenderer(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                   const SobolPoints& camera_points, const SobolPoints& light_points)
        : view_(view), lit_(lit), config_(config), camera_(camera_points), light_(light_points) {}

    /// The first samples of a row's pixels.
    void begin_row(int y, std::span<Tally> row) {
        for (int x0 = 0; x0 < view_.width; x0 += static_cast<int>(lanes)) {
            count_ = static_cast<std::size_t>(std::min(static_cast<int>(lanes), view_.width - x0));
            for (std::size_t k = 0; k < static_cast<std::size_t>(config_.samples_per_pixel); ++k) {
                for (std::size_t lane = 0; lane < count_; ++lane)
                    lane_[lane] = {x0 + static_cast<int>(lane), y, k};
                take_samples();
                for (std::size_t lane = 0; lane < count_; ++lane)
                    row[static_cast<std::size_t>(lane_[lane].x)].add(seen_[lane]);
            }
        }
    }

    /// The other samples of those that need them.
    void refine_row(int y, std::span<Tally> row) {
        const auto most = static_cast<std::size_t>(config_.most_samples_per_pixel);
        for (int x = 0; x < view_.width; ++x) {
            Tally& tally = row[static_cast<std::size_t>(x)];
            if (!tally.is_noisy(config_.noise)) continue;
            for (auto k = static_cast<std::size_t>(config_.samples_per_pixel); k < most; k += lanes) {
                count_ = std::min(lanes, most - k);
                for (std::size_t lane = 0; lane < count_; ++lane) lane_[lane] = {x, y, k + lane};
                take_samples();
                for (std::size_t lane = 0; lane < count_; ++lane) tally.add(seen_[lane]);
            }
        }
    }
    [[nodiscard]] std::uint64_t rays_traced() const { return rays_traced_; }

  private:
    void take_samples() {
        trace_camera_rays();
        if (lit_.direct != nullptr && !lit_.direct->empty()) add_lamps();
        for (const LightInPlace& light : lit_.lights) add_light(light);
    }

    void trace_camera_rays() {
        RayPacket rays;
        rays.count = static_cast<Index>(count_);
        for (std::size_t lane = 0; lane < count_; ++lane) {
            const auto& [x, y, k] = lane_[lane];
            const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(view_.width) +
                               static_cast<std::uint64_t>(x);
            seed_[lane] = mixed(config_.seed, pixel);
            const Sample4 s = camera_.at(k, seed_[lane]);
            rays.set(lane, view_.ray(static_cast<float>(x) + s[0], static_cast<float>(y) + s[1]));
        }
        HitPacket hits;
        lit_.caster->nearest(rays, Scope::everything, hits);
        rays_traced_ += count_;
        for (std::size_t lane = 0; lane < count_; ++lane)
            seen_[lane] = look_at(lit_, rays.ray(lane), hits[lane]);
    }

    void add_lamps() {
        const auto samples = static_cast<std::size_t>(config_.light_samples_per_point);
        for (std::size_t i = 0; i < samples; ++i) {
            trace_shadows(1 / static_cast<float>(samples), [&](std::size_t lane) {
                const Sample4 s = light_.at(lane_[lane].k * samples + i, mixed(seed_[lane]));
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
    std::array<LaneSample, lanes> lane_;
    std::array<std::uint64_t, lanes> seed_{};  // of the lane's pixel
    std::array<SeenPoint, lanes> seen_;
    std::uint64_t rays_traced_ = 0;
};

}  // namespace

Rgb interpolated_irradiance(const LitWorld& lit, const Ray& ray, const Hit& hit) {
    const Pose& pose = lit.caster->pose(hit.body);
    const Vec3 at = ray.origin + hit.distance * ray.direction;
    const Vec3 in_body = hit.body == furniture ? at : glm::conjugate(pose.rotation) * (at - pose.translation);
    const Stencil stencil = lit.interpolation->at(hit.body, hit.triangle, hit.side, in_body);
    return Interpolation::value(stencil, lit.irradiance, lit.confidence);
}

Picture render_picture(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                       std::uint64_t& rays_traced, const Context& context) {
    const auto width = static_cast<std::size_t>(view.width);
    const auto samples =
        static_cast<std::size_t>(std::max(config.samples_per_pixel, config.most_samples_per_pixel));
    const SobolPoints camera_points(samples);
    const SobolPoints light_points(samples * static_cast<std::size_t>(config.light_samples_per_point));
    Picture picture(view.width, view.height);
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(static_cast<std::size_t>(view.height), 4, [&](std::size_t begin, std::size_t end) {
        PacketRenderer renderer(view, lit, config, camera_points, light_points);
        std::vector<Tally> row;
        for (std::size_t y = begin; y < end; ++y) {
            row.assign(width, {});
            renderer.begin_row(static_cast<int>(y), row);
            renderer.refine_row(static_cast<int>(y), row);
            for (std::size_t x = 0; x < width; ++x)
                picture.at(static_cast<int>(x), static_cast<int>(y)) =
                    row[x].sum / static_cast<float>(row[x].count);
        }
        traced += renderer.rays_traced();
    });
    rays_traced += traced;
    return picture;
}

}  // namespace afterglow
