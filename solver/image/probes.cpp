#include "solver/image/probes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "solver/base/error.h"
#include "solver/image/probe_choice.h"

namespace afterglow {

namespace {

// Camera rays, on a pixel and its eight neighbours, that look for a lamp: seven a pixel.
constexpr std::size_t lamp_looks = 64;
// Pixels a thread takes at a time.
constexpr std::size_t pixels_per_chunk = 4;
// Told apart from each other and from the samples of the picture under test, which must be independent.
constexpr std::uint64_t probe_salt = 0x70726f626573;
enum class Purpose : std::uint64_t { lamp, camera, lamps, bounce, path };
// Parts of the first look; the others count from 0.
constexpr int first_pilot_part = 1 << 30;
// Parts of a pixel are at least this share of the mean number, and at most so many times it.
constexpr double least_parts_share = 0.5, most_parts_ratio = 8;

/// What a first look at a pixel says.
struct Pilot {
    bool used = false;    // not near a lamp
    double variance = 0;  // of one path, summed over channels
};

/// What one pixel says, times its weight: unbiased estimates, summed over channels.
struct Tally {
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

    /// How noisy a pixel's paths are, told from paths that serve nothing else: the number of its parts must
    /// not depend on them.
    [[nodiscard]] Pilot look(const Probe& probe, std::uint64_t& rays) const {
        if (sees_lamp(probe, rays)) return {};
        glm::dvec3 sum(0), squares(0);
        for (int k = 0; k < config_.pilot_samples; ++k) {
            const glm::dvec3 light = estimate_light(probe, first_pilot_part + k, {1, 1}, rays);
            sum += light;
            squares += light * light;
        }
        const double n = config_.pilot_samples;
        return {true, std::max(0.0, glm::dot(squares - sum * sum / n, glm::dvec3(1)) / (n - 1))};
    }

    [[nodiscard]] Tally probe(const Probe& probe, int parts, std::uint64_t& rays) const {
        const glm::dvec3 value(picture_.at(probe.x, probe.y));
        glm::dvec3 sum(0), squares(0), error_sum(0), error_squares(0);
        for (int part = 0; part < parts; ++part) {
            const glm::dvec3 light =
                estimate_light(probe, part, {config_.samples_per_part, config_.paths_per_sample}, rays);
            sum += light;
            squares += light * light;
            error_sum += value - light;
            error_squares += (value - light) * (value - light);
        }
        // The mean over all pairs of different parts, without visiting each.
        const double pairs = static_cast<double>(parts) * (parts - 1);
        const auto of_pairs = [&](const glm::dvec3& total, const glm::dvec3& same) {
            return probe.weight * glm::dot((total * total - same) / pairs, glm::dvec3(1));
        };
        return {of_pairs(error_sum, error_squares), of_pairs(sum, squares)};
    }

  private:
    struct Counts {
        int samples, paths_per_sample;
    };

    [[nodiscard]] static std::uint64_t seed_of(const Probe& probe, int part, Purpose purpose) {
        return mixed(mixed(probe.seed, static_cast<std::uint64_t>(part)),
                     static_cast<std::uint64_t>(purpose));
    }

    /// Whether a shining lamp shows within one pixel.
    [[nodiscard]] bool sees_lamp(const Probe& pixel, std::uint64_t& rays) const {
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
    [[nodiscard]] Rgb estimate_light(const Probe& pixel, int part, const Counts& counts,
                                     std::uint64_t& rays) const {
        const std::uint64_t camera_seed = seed_of(pixel, part, Purpose::camera);
        const std::uint64_t lamp_seed = seed_of(pixel, part, Purpose::lamps);
        const std::uint64_t bounce_seed = seed_of(pixel, part, Purpose::bounce);
        RandomStream random(seed_of(pixel, part, Purpose::path));
        const auto samples = static_cast<std::size_t>(counts.samples);
        const auto paths = static_cast<std::size_t>(counts.paths_per_sample);
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

/// How many parts each probe takes. The variance of a probe's pairs goes with the square of its noise over
/// that of its parts, so the sum over probes is least where parts go with the noise to the power of 2/3.
std::vector<int> share_out_parts(const std::vector<Probe>& probes, const std::vector<Pilot>& pilots,
                                 const ProbeConfig& config) {
    std::vector<double> wanted;
    double sum = 0, used = 0;
    for (std::size_t k = 0; k < probes.size(); ++k) {
        wanted.push_back(std::pow(probes[k].weight * pilots[k].variance, 2 / 3.0));
        sum += wanted.back();
        used += pilots[k].used ? 1 : 0;
    }
    std::vector<int> parts;
    for (std::size_t k = 0; k < probes.size(); ++k) {
        const double mean = config.parts;
        const double share = sum > 0 ? wanted[k] / sum * used : 1;
        const double count = mean * std::clamp(share, least_parts_share, most_parts_ratio);
        parts.push_back(pilots[k].used ? std::max(2, static_cast<int>(std::lround(count))) : 0);
    }
    return parts;
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
    at_least("pilot_samples", config.pilot_samples, 2);
    if (picture.pixels.empty() || picture.width != view.width || picture.height != view.height)
        throw Error(ErrorKind::invalid_input, "picture", "must be of the size that the camera's view is for");
}

/// The root of a ratio of means, and its spread by the delta method.
ProbeEstimate estimate_of(const std::vector<Tally>& tallies) {
    double error = 0, light = 0;
    for (const Tally& t : tallies) {
        error += t.squared_error;
        light += t.squared_light;
    }
    ProbeEstimate out;
    if (!(light > 0)) return out;  // nothing to be relative to
    const double ratio = error / light;
    const auto count = static_cast<double>(tallies.size());
    double squares = 0;
    for (const Tally& t : tallies) squares += std::pow(t.squared_error - ratio * t.squared_light, 2);
    const double spread = count > 1 ? std::sqrt(squares * count / (count - 1)) / light : 0;
    out.relative_error = std::sqrt(std::max(ratio, 0.0));
    // Near zero a root has no slope to go by; the step that it takes stays finite.
    out.standard_error = std::sqrt(std::max(ratio, 0.0) + spread) - out.relative_error;
    return out;
}

double left_out_share(const std::vector<Probe>& probes, const std::vector<Pilot>& pilots) {
    double out = 0, all = 0;
    for (std::size_t k = 0; k < probes.size(); ++k) {
        all += probes[k].weight;
        if (!pilots[k].used) out += probes[k].weight;
    }
    return out / all;
}

/// Calls `visit(k, rays)` for every probe, on all threads, and returns the sum of rays.
template <class Visit>
std::uint64_t for_probes(std::size_t count, const Context& context, const Visit& visit) {
    std::atomic<std::uint64_t> traced = 0;
    context.for_chunks(count, pixels_per_chunk, [&](std::size_t begin, std::size_t end) {
        std::uint64_t rays = 0;
        for (std::size_t k = begin; k < end; ++k) visit(k, rays);
        traced += rays;
    });
    return traced;
}

}  // namespace

ProbeEstimate estimate_error(const Picture& picture, const CameraView& view, const PathScene& scene,
                             const ProbeConfig& config, std::uint64_t& rays_traced, const Context& context) {
    check(picture, view, config);
    const std::vector<Probe> probes = choose_probes(picture, config.pixels, config.seed ^ probe_salt);
    const Prober prober(picture, view, scene, config);
    std::vector<Pilot> pilots(probes.size());
    rays_traced += for_probes(probes.size(), context, [&](std::size_t k, std::uint64_t& rays) {
        pilots[k] = prober.look(probes[k], rays);
    });
    const std::vector<int> parts = share_out_parts(probes, pilots, config);
    std::vector<Tally> tallies(probes.size());
    rays_traced += for_probes(probes.size(), context, [&](std::size_t k, std::uint64_t& rays) {
        if (pilots[k].used) tallies[k] = prober.probe(probes[k], parts[k], rays);
    });
    ProbeEstimate estimate = estimate_of(tallies);
    estimate.left_out_share = left_out_share(probes, pilots);
    return estimate;
}

}  // namespace afterglow
