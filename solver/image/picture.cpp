#include "solver/image/picture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <span>
#include <vector>

#include "solver/image/camera_samples.h"
#include "solver/image/picture_tiles.h"
#include "solver/image/pixel_sum.h"
#include "solver/image/seen_point.h"
#include "solver/image/shadow_lines.h"

namespace afterglow {

namespace {

constexpr std::size_t lanes = 16;
constexpr std::size_t edge = PictureTiles::edge;

/// Takes sixteen samples at a time: of neighbouring pixels, or of one.
class PacketRenderer {
  public:
    PacketRenderer(const CameraView& view, const LitWorld& lit, const PictureConfig& config,
                   const CameraSamples& samples, const ShadowLines& lines)
        : view_(view), lit_(lit), config_(config), samples_(samples), lines_(lines), shadows_(lines) {}

    /// A row of tiles, from pixel row `top` on.
    void render(int top, Picture& picture) {
        const int bottom = std::min(top + PictureTiles::edge, view_.height);
        for (int left = 0; left < view_.width; left += static_cast<int>(lanes)) {
            const int right = std::min(left + static_cast<int>(lanes), view_.width);
            for (int y = top; y < bottom; ++y)
                begin(left, right, y, std::span(first_).subspan(static_cast<std::size_t>(y - top) * lanes));
            for (int x = left; x < right; x += PictureTiles::edge)
                finish_tile(left, x, std::min(x + PictureTiles::edge, right), top, bottom, picture);
        }
    }
    [[nodiscard]] std::uint64_t rays_traced() const { return rays_traced_; }

  private:
    /// The first samples of a row's pixels.
    void begin(int left, int right, int y, std::span<PixelSum> pixels) {
        count_ = static_cast<std::size_t>(right - left);
        for (PixelSum& pixel : pixels.first(count_)) pixel.clear();
        for (std::size_t k = 0; k < static_cast<std::size_t>(config_.samples_per_pixel); ++k) {
            for (std::size_t lane = 0; lane < count_; ++lane)
                lane_[lane] = {left + static_cast<int>(lane), y, k};
            take_samples();
            for (std::size_t lane = 0; lane < count_; ++lane) add_to(pixels[lane], lane);
        }
    }

    /// Pixels [from, to) of rows [top, bottom), whose first ones begin at `left`.
    void finish_tile(int left, int from, int to, int top, int bottom, Picture& picture) {
        const auto first_of = [&](int x, int y) -> const PixelSum& {
            return first_[static_cast<std::size_t>(y - top) * lanes + static_cast<std::size_t>(x - left)];
        };
        const auto place_of = [&](int x, int y) {
            return static_cast<std::size_t>(y - top) * edge + static_cast<std::size_t>(x - from);
        };
        TileTotals tile{};
        for (int y = top; y < bottom; ++y)
            for (int x = from; x < to; ++x) tile[place_of(x, y)] = &first_of(x, y).totals();
        for (int y = top; y < bottom; ++y)
            for (int x = from; x < to; ++x) {
                const PixelSum& first = first_of(x, y);
                const Rgb by_patches = light_of(first.patches(), lit_.irradiance);
                further_.clear();
                if (first.totals().is_noisy(config_.noise, by_patches) ||
                    may_miss_light(tile, place_of(x, y)))
                    take_further(x, y);
                picture.at(x, y) = mean_of(first.totals(), by_patches, further_.totals(),
                                           light_of(further_.patches(), lit_.irradiance));
            }
    }

    void take_further(int x, int y) {
        const auto most = static_cast<std::size_t>(config_.most_samples_per_pixel);
        for (auto k = static_cast<std::size_t>(config_.samples_per_pixel); k < most; k += lanes) {
            count_ = std::min(lanes, most - k);
            for (std::size_t lane = 0; lane < count_; ++lane) lane_[lane] = {x, y, k + lane};
            take_samples();
            for (std::size_t lane = 0; lane < count_; ++lane) add_to(further_, lane);
        }
    }

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
    std::array<PixelSum, edge * lanes> first_;  // the samples every pixel has, of some tiles side by side
    PixelSum further_;                          // those that a noisy pixel has besides
    std::uint32_t taking_light_ = 0;            // lanes whose points do
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
    const CameraSamples samples(view, config);
    const ShadowLines lines(lit, config);
    Picture picture(view.width, view.height);
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(static_cast<std::size_t>(view.height), edge, [&](std::size_t begin, std::size_t end) {
        PacketRenderer renderer(view, lit, config, samples, lines);
        for (std::size_t top = begin; top < end; top += edge) renderer.render(static_cast<int>(top), picture);
        traced += renderer.rays_traced();
    });
    rays_traced += traced;
    return picture;
}

}  // namespace afterglow
