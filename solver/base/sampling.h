#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/base/math.h"

namespace afterglow {

/// A well-mixed number from a number (splitmix64). Purpose: independent seeds from one seed and a counter.
std::uint64_t mixed(std::uint64_t value);
inline std::uint64_t mixed(std::uint64_t seed, std::uint64_t value) {
    return mixed(seed ^ mixed(value));
}

/// Independent numbers, uniform in [0,1) with 24 bits, one after the other (splitmix64). Purpose: estimates
/// whose noise is itself measured from their samples; Sobol points are less noisy but not independent.
/// Streams of different well-mixed seeds are independent of each other. One thread at a time.
class RandomStream {
  public:
    explicit RandomStream(std::uint64_t seed) : state_(seed) {}
    float next();

  private:
    std::uint64_t state_;
};

/// A four-dimensional low-discrepancy point in [0,1)⁴.
using Sample4 = std::array<float, 4>;

/// The first points of Sobol's sequence in four dimensions, and scrambled copies of them. Every scrambling is
/// a (0,2)-sequence in its first two dimensions; prefixes of 2^k points are well spread. Source: Sobol 1967
/// with Joe and Kuo's direction numbers; nested uniform scrambling by hashing, Burley 2020. Thread-safety:
/// const after construction.
class SobolPoints {
  public:
    explicit SobolPoints(std::size_t count);

    [[nodiscard]] std::size_t size() const { return points_.size(); }
    /// Point `index` of the scrambling that `seed` selects.
    [[nodiscard]] Sample4 at(std::size_t index, std::uint64_t seed) const;

    /// What `at` makes of a seed for one dimension.
    [[nodiscard]] static std::uint32_t seed_of(std::uint64_t seed, std::size_t dimension);
    /// One dimension of sixteen points, each of a scrambling of its own: what `at` gives, to the bit.
    void at(std::size_t dimension, const std::array<std::uint32_t, 16>& index,
            const std::array<std::uint32_t, 16>& seed, std::array<float, 16>& out) const;

  private:
    std::vector<std::array<std::uint32_t, 4>> points_;
};

/// A direction around +z with density cos θ / π, from a point of the unit square by Shirley and Chiu's
/// concentric map.
Vec3 cosine_direction(float u, float v);

}  // namespace afterglow
