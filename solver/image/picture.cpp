#include "solver/image/picture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <span>
#include <vector>

#include "solver/image/camera_samples.h"
#include "solver/image/pixel_sum.h"
#include "solver/image/seen_point.h"
#include "solver/image/shadow_lines.h"

namespace afterglow {

namespace {

constexpr std::size_t lanes = 16;

/// A pixel as it is being made.
struct Pixel {
    PixelSum first, further;  // the samples every pixel has, and those of noisy ones besides

    [[nodiscard]] Rgb mean(std::span<const Rgb> irradiance) const {
        return mean_of(first.totals(), light_of(first.patches(), irradiance), further.totals(),
                       light_of(further.patches(), irradiance));
    }
};

/// Takes sixteen samples at a time: of neighbouring pixels, or of one.
class PacketRenderer {
  public:
    PacketRenderer(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                   const CameraSamples& samples, const ShadowLines& lines)
        : view_(view), lit_(lit), config_(config), samples_(samples), lines_(lines), shadows_(lines) {}

    /// The first samples of a row's pixels.
    void begin_row(int y, std::span<Pixel> row) {
        for (int x0 = 0; x0 < view_.width; x0 += static_cast<int>(lanes)) {
            count_ = static_cast<std::size_t>(std::min(static_cast<int>(lanes), view_.width - x0));
            for (std::size_t k = 0; k < static_cast<std::size_t>(config_.samples_per_pixel); ++k) {
                for (std::size_t lane = 0; lane < count_; ++lane)
                    lane_[lane] = {x0 + static_cast<int>(lane), y, k};
                take_samples();
                for (std::size_t lane = 0; lane < count_; ++lane)
                    add_to(row[static_cast<std::size_t>(lane_[lane].x)].first, lane);
            }
        }
    }

    /// The other samples of those that need them.
    void refine_row(int y, std::span<Pixel> row) {
        const auto most = static_cast<std::size_t>(config_.most_samples_per_pixel);
        for (int x = 0; x < view_.width; ++x) {
            Pixel& pixel = row[static_cast<std::size_t>(x)];
            const Rgb by_patches = light_of(pixel.first.patches(), lit_.irradiance);
            if (!pixel.first.totals().is_noisy(config_.noise, by_patches)) continue;
            for (auto k = static_cast<std::size_t>(config_.samples_per_pixel); k < most; k += lanes) {
                count_ = std::min(lanes, most - k);
                for (std::size_t lane = 0; lane < count_; ++lane) lane_[lane] = {x, y, k + lane};
                take_samples();
                for (std::size_t lane = 0; lane < count_; ++lane) add_to(pixel.further, lane);
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

    void add_to(PixelSum& sum, std::size_t lane) const {
        const SeenPoint& seen = seen_[lane];
        sum.add({seen.emitted, seen.reflectance, direct_[lane], seen.surface, seen.stencil.patches()},
                lit_.confidence);
    }

    void trace_camera_rays() {
        RayPacket rays;
        samples_.rays(lane_, count_, rays, number_);
        HitPacket hits;
        lit_.caster->nearest(rays, Scope::everything, hits);
        rays_traced_ += count_;
        taking_light_ = 0;
        for (std::size_t lane = 0; lane < count_; ++lane) {
            seen_[lane] = look_at(lit_, rays.ray(lane), hits[lane]);
            if (!seen_[lane].takes_light()) continue;
            taking_light_ |= 1U << lane;
            shadows_.set(lane, seen_[lane].position, seen_[lane].normal, number_[lane]);
        }
        shadows_.look(count_);
    }

    /// Adds what each lane's line `i` brings where nothing stands between.
    void trace_shadows(std::size_t i) {
        ShadowLinePacket lines;
        shadows_.at(i, taking_light_, lines);
        if (lines.alive == 0) return;
        rays_traced_ += static_cast<std::uint64_t>(std::popcount(lines.alive));
        const std::uint32_t free = lines.alive & ~lit_.caster->occluded(lines.rays, Scope::everything);
        for (std::size_t lane = 0; lane < count_; ++lane)
            if (((free >> lane) & 1U) != 0) direct_[lane] += lines.gain[lane];
    }

    const CameraView& view_;
    const LitWorld& lit_;
    const PictureConfig& config_;
    const CameraSamples& samples_;
    const ShadowLines& lines_;
    ShadowPacket shadows_;
    std::uint32_t taking_light_ = 0;  // lanes whose points do
    std::size_t count_ = 0;
    std::array<CameraSample, lanes> lane_;
    std::array<SampleNumber, lanes> number_;
    std::array<SeenPoint, lanes> seen_;
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
    const CameraSamples samples(view, config);
    const ShadowLines lines(lit, config);
    Picture picture(view.width, view.height);
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(static_cast<std::size_t>(view.height), 4, [&](std::size_t begin, std::size_t end) {
        PacketRenderer renderer(view, lit, config, samples, lines);
        std::vector<Pixel> row(width);
        for (std::size_t y = begin; y < end; ++y) {
            for (Pixel& pixel : row) {
                pixel.first.clear();
                pixel.further.clear();
            }
            renderer.begin_row(static_cast<int>(y), row);
            renderer.refine_row(static_cast<int>(y), row);
            for (std::size_t x = 0; x < width; ++x)
                picture.at(static_cast<int>(x), static_cast<int>(y)) = row[x].mean(lit.irradiance);
        }
        traced += renderer.rays_traced();
    });
    rays_traced += traced;
    return picture;
}

}  // namespace afterglow
