#include "solver/image/picture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "solver/base/sampling.h"
#include "solver/image/pixel_tally.h"
#include "solver/image/seen_point.h"
#include "solver/image/shadow_lines.h"

namespace afterglow {

namespace {

constexpr std::size_t lanes = 16;

/// Which sample of which pixel a lane takes.
struct LaneSample {
    int x = 0, y = 0;
    std::size_t k = 0;
};

/// Takes sixteen samples at a time: of neighbouring pixels, or of one.
class PacketRenderer {
  public:
    PacketRenderer(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                   const SobolPoints& camera_points, const ShadowLines& lines)
        : view_(view), lit_(lit), config_(config), camera_(camera_points), lines_(lines) {}

    /// The first samples of a row's pixels.
    void begin_row(int y, std::span<PixelTally> row) {
        for (int x0 = 0; x0 < view_.width; x0 += static_cast<int>(lanes)) {
            count_ = static_cast<std::size_t>(std::min(static_cast<int>(lanes), view_.width - x0));
            for (std::size_t k = 0; k < static_cast<std::size_t>(config_.samples_per_pixel); ++k) {
                for (std::size_t lane = 0; lane < count_; ++lane)
                    lane_[lane] = {x0 + static_cast<int>(lane), y, k};
                take_samples();
                for (std::size_t lane = 0; lane < count_; ++lane)
                    add_to(row[static_cast<std::size_t>(lane_[lane].x)], lane);
            }
        }
    }

    /// The other samples of those that need them.
    void refine_row(int y, std::span<PixelTally> row) {
        const auto most = static_cast<std::size_t>(config_.most_samples_per_pixel);
        for (int x = 0; x < view_.width; ++x) {
            PixelTally& tally = row[static_cast<std::size_t>(x)];
            if (!tally.is_noisy(config_.noise)) continue;
            for (auto k = static_cast<std::size_t>(config_.samples_per_pixel); k < most; k += lanes) {
                count_ = std::min(lanes, most - k);
                for (std::size_t lane = 0; lane < count_; ++lane) lane_[lane] = {x, y, k + lane};
                take_samples();
                for (std::size_t lane = 0; lane < count_; ++lane) add_to(tally, lane);
            }
        }
    }
    [[nodiscard]] std::uint64_t rays_traced() const { return rays_traced_; }

  private:
    void take_samples() {
        trace_camera_rays();
        direct_.fill(Rgb(0));
        for (std::size_t i = 0; i < lines_.count(); ++i) trace_shadows(i);
    }

    void add_to(PixelTally& tally, std::size_t lane) const {
        const SeenPoint& seen = seen_[lane];
        const Rgb interpolated = Interpolation::value(seen.stencil, lit_.irradiance, lit_.confidence);
        tally.add(radiance_of(seen.emitted, seen.reflectance, interpolated, direct_[lane]), seen.surface);
    }

    void trace_camera_rays() {
        RayPacket rays;
        rays.count = static_cast<Index>(count_);
        for (std::size_t lane = 0; lane < count_; ++lane) {
            const auto& [x, y, k] = lane_[lane];
            const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(view_.width) +
                               static_cast<std::uint64_t>(x);
            number_[lane] = {mixed(config_.seed, pixel), k};
            const Sample4 s = camera_.at(k, number_[lane].pixel_seed);
            rays.set(lane, view_.ray(static_cast<float>(x) + s[0], static_cast<float>(y) + s[1]));
        }
        HitPacket hits;
        lit_.caster->nearest(rays, Scope::everything, hits);
        rays_traced_ += count_;
        for (std::size_t lane = 0; lane < count_; ++lane) {
            seen_[lane] = look_at(lit_, rays.ray(lane), hits[lane]);
            if (seen_[lane].takes_light())
                lines_.look_from(seen_[lane].position, seen_[lane].normal, lamps_[lane]);
        }
    }

    /// Adds what each lane's line `i` brings where nothing stands between.
    void trace_shadows(std::size_t i) {
        RayPacket rays;
        rays.count = static_cast<Index>(count_);
        std::array<Rgb, lanes> gain;
        Index alive = 0;
        for (std::size_t lane = 0; lane < count_; ++lane) {
            const SeenPoint& seen = seen_[lane];
            const ShadowLine line =
                seen.takes_light() ? lines_.at(i, number_[lane], lamps_[lane]) : ShadowLine{};
            gain[lane] = line.irradiance;
            const bool lit = line.brings_light();
            // A ray that ends where it starts is switched off.
            rays.set(lane, {seen.position, lit ? line.direction : Vec3(0, 0, 1), lit ? line.far_m : 0.0F});
            alive += lit ? 1U : 0U;
        }
        if (alive == 0) return;
        rays_traced_ += alive;
        const std::uint32_t blocked = lit_.caster->occluded(rays, Scope::everything);
        for (std::size_t lane = 0; lane < count_; ++lane)
            if (((blocked >> lane) & 1U) == 0) direct_[lane] += gain[lane];
    }

    const CameraView& view_;
    const LitWorld& lit_;
    const PictureConfig& config_;
    const SobolPoints& camera_;
    const ShadowLines& lines_;
    std::size_t count_ = 0;
    std::array<LaneSample, lanes> lane_;
    std::array<SampleNumber, lanes> number_;
    std::array<SeenPoint, lanes> seen_;
    std::array<DirectLight::Seen, lanes> lamps_;
    std::array<Rgb, lanes> direct_;
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
    const SobolPoints camera_points(most_samples(config));
    const ShadowLines lines(lit, config);
    Picture picture(view.width, view.height);
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(static_cast<std::size_t>(view.height), 4, [&](std::size_t begin, std::size_t end) {
        PacketRenderer renderer(view, lit, config, camera_points, lines);
        std::vector<PixelTally> row;
        for (std::size_t y = begin; y < end; ++y) {
            row.assign(width, {});
            renderer.begin_row(static_cast<int>(y), row);
            renderer.refine_row(static_cast<int>(y), row);
            for (std::size_t x = 0; x < width; ++x)
                picture.at(static_cast<int>(x), static_cast<int>(y)) = row[x].mean();
        }
        traced += renderer.rays_traced();
    });
    rays_traced += traced;
    return picture;
}

}  // namespace afterglow
