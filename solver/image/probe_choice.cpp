#include "solver/image/probe_choice.h"

#include <algorithm>
#include <cmath>

#include "solver/base/sampling.h"

namespace afterglow {

namespace {

// Pixels looked at for unevenness, for each one probed.
constexpr std::size_t candidates_per_probe = 16;
// Of the probes, this share is chosen evenly: no weight is larger than its inverse.
constexpr double even_share = 0.5;
// What is brighter than this many times the mean is a lamp or beside one, and left out later.
constexpr float brightest_per_mean = 4;
// The choice's own random numbers, apart from those of the probes, which are numbered from 0.
constexpr std::uint64_t choice = ~std::uint64_t{0};

/// The standard deviation of a pixel and its neighbours, of channels added up, bright ones cut off.
double unevenness(const Picture& picture, int x, int y, float brightest) {
    double sum = 0, squares = 0, count = 0;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, picture.height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, picture.width - 1); ++u) {
            const double value = std::min(glm::dot(picture.at(u, v), Rgb(1)), brightest);
            sum += value;
            squares += value * value;
            ++count;
        }
    return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
}

/// A number that puts near pixels near each other: the bits of both coordinates in turn (Morton 1966).
std::uint64_t place_on_curve(const Probe& probe) {
    std::uint64_t place = 0;
    for (unsigned bit = 0; bit < 16; ++bit)
        place |= ((static_cast<std::uint64_t>(probe.x) >> bit & 1U) << (2 * bit)) |
                 ((static_cast<std::uint64_t>(probe.y) >> bit & 1U) << (2 * bit + 1));
    return place;
}

std::vector<Probe> spread_evenly(const Picture& picture, std::size_t count, std::uint64_t seed) {
    std::vector<Probe> probes;
    const SobolPoints points(count);
    for (std::size_t k = 0; k < count; ++k) {
        const Sample4 s = points.at(k, seed);
        const auto place = [](float share, int pixels) {
            return std::min(static_cast<int>(share * static_cast<float>(pixels)), pixels - 1);
        };
        probes.push_back({place(s[0], picture.width), place(s[1], picture.height)});
    }
    return probes;
}

/// Chosen from candidates spread evenly, half of them by chance alone, half by how uneven the picture is
/// around: that is where its errors are.
std::vector<Probe> choose_uneven(const Picture& picture, std::size_t asked, std::uint64_t seed) {
    std::vector<Probe> candidates = spread_evenly(picture, asked * candidates_per_probe, seed);
    std::sort(candidates.begin(), candidates.end(),
              [](const Probe& a, const Probe& b) { return place_on_curve(a) < place_on_curve(b); });
    double light = 0;
    for (const Probe& c : candidates) light += static_cast<double>(glm::dot(picture.at(c.x, c.y), Rgb(1)));
    const auto count = static_cast<double>(candidates.size());
    const auto brightest = brightest_per_mean * static_cast<float>(light / count);
    double total = 0;
    for (Probe& c : candidates) total += c.weight = unevenness(picture, c.x, c.y, brightest);

    std::vector<Probe> chosen;
    RandomStream random(mixed(seed));
    double passed = 0;
    auto next = static_cast<double>(random.next());
    for (const Probe& c : candidates) {
        const double share = total > 0 ? even_share / count + (1 - even_share) * c.weight / total : 1 / count;
        passed += share * static_cast<double>(asked);
        // One in each of `asked` equal steps.
        for (; next < passed; next = static_cast<double>(chosen.size()) + static_cast<double>(random.next()))
            chosen.push_back({c.x, c.y, 1 / (count * share)});
    }
    return chosen;
}

}  // namespace

std::vector<Probe> choose_probes(const Picture& picture, int count, std::uint64_t seed) {
    std::vector<Probe> chosen;
    if (picture.pixels.size() <= static_cast<std::size_t>(count)) {
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) chosen.push_back({x, y});
    } else {
        chosen = choose_uneven(picture, static_cast<std::size_t>(count), mixed(seed, choice));
    }
    for (std::size_t k = 0; k < chosen.size(); ++k) chosen[k].seed = mixed(seed, k);
    return chosen;
}

}  // namespace afterglow
