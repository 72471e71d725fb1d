#include "solver/image/probes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "solver/base/error.h"

namespace afterglow {

namespace {

// Camera rays, on a pixel and its eight neighbours, that look for a lamp: seven a pixel.
constexpr std::size_t lamp_looks = 64;
// Pixels a thread takes at a time.
constexpr std::size_t pixels_per_chunk = 4;
// Told apart from each other and from the samples of the picture under test, which must be independent.
constexpr std::uint64_t probe_salt = 0x70726f626573;
enum class Purpose : std::uint64_t { choice, lamp, camera, lamps, bounce, path };

struct ProbePixel {
    int x = 0, y = 0;
};

/// What one pixel says: unbiased estimates, summed over channels.
struct Tally {
    bool used = false;
    double squared_error = 0;  // of (picture − truth)²
    double squared_light = 0;  // of truth²
};

/// Ways of taking one pixel apart from the others.
class Prober {
  public:
    Prober(const Picture& picture, const CameraView& view, const PathScene& scene, const ProbeConfig& config)
        : picture_(picture),
          view_(view),
          scene_(scene),
          config_(config),
          points_(std::max(lamp_looks, static_cast<std::size_t>(config.samples_per_part) *
                                           static_cast<std::size_t>(config.paths_per_sample))) {}

    [[nodiscard]] Tally probe(const ProbePixel& pixel, std::uint64_t& rays) const {
        if (sees_lamp(pixel, rays)) return {};
        const glm::dvec3 value(picture_.at(pixel.x, pixel.y));
        glm::dvec3 sum(0), squares(0), error_sum(0), error_squares(0);
        for (int part = 0; part < config_.parts; ++part) {
            const glm::dvec3 light = estimate_light(pixel, part, rays);
            sum += light;
            squares += light * light;
            error_sum += value - light;
            error_squares += (value - light) * (value - light);
        }
        // The mean over all pairs of different parts, without visiting each.
        const double pairs = static_cast<double>(config_.parts) * (config_.parts - 1);
        const auto of_pairs = [&](const glm::dvec3& total, const glm::dvec3& same) {
            return glm::dot((total * total - same) / pairs, glm::dvec3(1));
        };
        return {true, of_pairs(error_sum, error_squares), of_pairs(sum, squares)};
    }

  private:
    [[nodiscard]] std::uint64_t seed_of(const ProbePixel& pixel, int part, Purpose purpose) const {
        const auto number = static_cast<std::uint64_t>(pixel.y) * static_cast<std::uint64_t>(view_.width) +
                            static_cast<std::uint64_t>(pixel.x);
        const std::uint64_t of_part =
            mixed(mixed(config_.seed ^ probe_salt, number), static_cast<std::uint64_t>(part));
        return mixed(of_part, static_cast<std::uint64_t>(purpose));
    }

    /// Whether a shining lamp shows within one pixel.
    [[nodiscard]] bool sees_lamp(const ProbePixel& pixel, std::uint64_t& rays) const {
        const std::uint64_t seed = seed_of(pixel, 0, Purpose::lamp);
        for (std::size_t k = 0; k < lamp_looks; ++k) {
            const Sample4 s = points_.at(k, seed);
            const float x =
                std::clamp(static_cast<float>(pixel.x) - 1 + 3 * s[0], 0.0F, static_cast<float>(view_.width));
            const float y = std::clamp(static_cast<float>(pixel.y) - 1 + 3 * s[1], 0.0F,
                                       static_cast<float>(view_.height));
            const PathPoint met = follow(scene_, view_.ray(x, y), rays);
            if (met.light == PathPoint::Light::sampled && max_channel(met.emitted) > 0) return true;
        }
        return false;
    }

    /// An unbiased estimate of a pixel's radiance, independent of its other parts.
    [[nodiscard]] Rgb estimate_light(const ProbePixel& pixel, int part, std::uint64_t& rays) const {
        const std::uint64_t camera_seed = seed_of(pixel, part, Purpose::camera);
        const std::uint64_t lamp_seed = seed_of(pixel, part, Purpose::lamps);
        const std::uint64_t bounce_seed = seed_of(pixel, part, Purpose::bounce);
        RandomStream random(seed_of(pixel, part, Purpose::path));
        const auto samples = static_cast<std::size_t>(config_.samples_per_part);
        const auto paths = static_cast<std::size_t>(config_.paths_per_sample);
        Rgb sum(0);
        for (std::size_t k = 0; k < samples; ++k) {
            const Sample4 c = points_.at(k, camera_seed);
            const Ray ray = view_.ray(static_cast<float>(pixel.x) + c[0], static_cast<float>(pixel.y) + c[1]);
            const PathPoint at = follow(scene_, ray, rays);
            sum += at.emitted;
            if (max_channel(at.reflectance) <= 0) continue;
            const Sample4 l = points_.at(k, lamp_seed);
            sum += at.reflectance / pi * sampled_irradiance(scene_, at, {l[2], l[0], l[1]}, rays);
            Rgb gathered(0);
            for (std::size_t i = 0; i < paths; ++i) {
                const Sample4 b = points_.at(k * paths + i, bounce_seed);
                const Ray bounce{at.position, Frame(at.normal).to_world(cosine_direction(b[0], b[1]))};
                gathered += gathered_radiance(scene_, config_.path, bounce, random, rays);
            }
            sum += at.reflectance * gathered / static_cast<float>(paths);
        }
        return sum / static_cast<float>(samples);
    }

    const Picture& picture_;
    const CameraView& view_;
    const PathScene& scene_;
    const ProbeConfig& config_;
    SobolPoints points_;
};

/// Evenly spread pixels; all of a picture that has no more than are asked for.
std::vector<ProbePixel> choose_pixels(const Picture& picture, const ProbeConfig& config) {
    std::vector<ProbePixel> chosen;
    const auto asked = static_cast<std::size_t>(config.pixels);
    if (picture.pixels.size() <= asked) {
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) chosen.push_back({x, y});
        return chosen;
    }
    const SobolPoints points(asked);
    const std::uint64_t seed = mixed(config.seed ^ probe_salt, static_cast<std::uint64_t>(Purpose::choice));
    for (std::size_t k = 0; k < asked; ++k) {
        const Sample4 s = points.at(k, seed);
        const auto place = [](float share, int count) {
            return std::min(static_cast<int>(share * static_cast<float>(count)), count - 1);
        };
        chosen.push_back({place(s[0], picture.width), place(s[1], picture.height)});
    }
    return chosen;
}

void check(const Picture& picture, const CameraView& view, const ProbeConfig& config) {
    const auto at_least = [](const char* field, int value, int least) {
        if (value < least)
            throw Error(ErrorKind::invalid_input, field, "must be " + std::to_string(least) + " or more");
    };
    at_least("pixels", config.pixels, 1);
    at_least("parts", config.parts, 2);
    at_least("samples_per_part", config.samples_per_part, 1);
    at_least("paths_per_sample", config.paths_per_sample, 1);
    if (picture.pixels.empty() || picture.width != view.width || picture.height != view.height)
        throw Error(ErrorKind::invalid_input, "picture", "must be of the size that the camera's view is for");
}

/// The root of a ratio of means, and its spread by the delta method.
ProbeEstimate estimate_of(const std::vector<Tally>& tallies) {
    double error = 0, light = 0, count = 0;
    for (const Tally& t : tallies) {
        error += t.squared_error;
        light += t.squared_light;
        count += t.used ? 1 : 0;
    }
    ProbeEstimate out;
    out.left_out_share = 1 - count / static_cast<double>(tallies.size());
    if (!(light > 0)) return out;  // nothing to be relative to
    const double ratio = error / light;
    double squares = 0;
    for (const Tally& t : tallies) squares += std::pow(t.squared_error - ratio * t.squared_light, 2);
    const double spread = count > 1 ? std::sqrt(squares * count / (count - 1)) / light : 0;
    out.relative_error = std::sqrt(std::max(ratio, 0.0));
    // Near zero a root has no slope to go by; the step that it takes stays finite.
    out.standard_error = std::sqrt(std::max(ratio, 0.0) + spread) - out.relative_error;
    return out;
}

}  // namespace

ProbeEstimate estimate_error(const Picture& picture, const CameraView& view, const PathScene& scene,
                             const ProbeConfig& config, std::uint64_t& rays_traced, const Context& context) {
    check(picture, view, config);
    const std::vector<ProbePixel> pixels = choose_pixels(picture, config);
    const Prober prober(picture, view, scene, config);
    std::vector<Tally> tallies(pixels.size());
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(pixels.size(), pixels_per_chunk, [&](std::size_t begin, std::size_t end) {
        std::uint64_t rays = 0;
        for (std::size_t k = begin; k < end; ++k) tallies[k] = prober.probe(pixels[k], rays);
        traced += rays;
    });
    rays_traced += traced;
    return estimate_of(tallies);
}

}  // namespace afterglow
