#include "solver/base/sampling.h"

#include <algorithm>
#include <cmath>

namespace afterglow {

namespace {

[[gnu::always_inline]] inline std::uint32_t reversed(std::uint32_t x) {
    x = ((x >> 1U) & 0x55555555U) | ((x & 0x55555555U) << 1U);
    x = ((x >> 2U) & 0x33333333U) | ((x & 0x33333333U) << 2U);
    x = ((x >> 4U) & 0x0F0F0F0FU) | ((x & 0x0F0F0F0FU) << 4U);
    return __builtin_bswap32(x);
}

/// Owen's nested uniform scrambling: every bit is flipped by a hash of the bits above it.
[[gnu::always_inline]] inline std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
    x = reversed(x);
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= (seed >> 16U) | 1U;
    x ^= x * 0x05526c56U;
    x ^= x * 0x53a22864U;
    return reversed(x);
}

/// Direction numbers of one dimension: primitive polynomial of degree `degree` with inner coefficients `a`.
std::array<std::uint32_t, 32> direction_numbers(unsigned degree, std::uint32_t a,
                                                std::array<std::uint32_t, 3> m) {
    std::array<std::uint32_t, 32> v{};
    if (degree == 0) {
        for (unsigned i = 0; i < 32; ++i) v[i] = 1U << (31U - i);
        return v;
    }
    for (unsigned i = 0; i < degree; ++i) v[i] = m[i] << (31U - i);
    for (unsigned i = degree; i < 32; ++i) {
        v[i] = v[i - degree] ^ (v[i - degree] >> degree);
        for (unsigned k = 1; k < degree; ++k)
            if (((a >> (degree - 1U - k)) & 1U) != 0) v[i] ^= v[i - k];
    }
    return v;
}

float to_unit(std::uint32_t x) {
    return std::min(static_cast<float>(x) * 0x1p-32F, 0x1.fffffep-1F);
}

}  // namespace

std::uint64_t mixed(std::uint64_t value) {
    value += 0x9e3779b97f4a7c15U;
    value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9U;
    value = (value ^ (value >> 27U)) * 0x94d049bb133111ebU;
    return value ^ (value >> 31U);
}

float RandomStream::next() {
    const std::uint64_t value = mixed(state_);
    state_ += 0x9e3779b97f4a7c15U;
    return static_cast<float>(value >> 40U) * 0x1p-24F;
}

SobolPoints::SobolPoints(std::size_t count) : points_(count) {
    const std::array dimensions{direction_numbers(0, 0, {}), direction_numbers(1, 0, {1}),
                                direction_numbers(2, 1, {1, 3}), direction_numbers(3, 1, {1, 3, 1})};
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t d = 0; d < 4; ++d)
            for (unsigned bit = 0; bit < 32; ++bit)
                if (((i >> bit) & 1U) != 0) points_[i][d] ^= dimensions[d][bit];
}

Sample4 SobolPoints::at(std::size_t index, std::uint64_t seed) const {
    Sample4 out;
    for (std::size_t d = 0; d < 4; ++d) out[d] = to_unit(scrambled(points_[index][d], seed_of(seed, d)));
    return out;
}

std::uint32_t SobolPoints::seed_of(std::uint64_t seed, std::size_t dimension) {
    return static_cast<std::uint32_t>(mixed(seed, dimension));
}

void SobolPoints::at(std::size_t dimension, const std::array<std::uint32_t, 16>& index,
                     const std::array<std::uint32_t, 16>& seed, std::array<float, 16>& out) const {
    std::array<std::uint32_t, 16> point;
    for (std::size_t lane = 0; lane < point.size(); ++lane) point[lane] = points_[index[lane]][dimension];
    for (std::size_t lane = 0; lane < point.size(); ++lane)
        out[lane] = to_unit(scrambled(point[lane], seed[lane]));
}

Vec3 cosine_direction(float u, float v) {
    const float a = 2 * u - 1, b = 2 * v - 1;
    if (a == 0 && b == 0) return {0, 0, 1};
    const bool wide = std::abs(a) > std::abs(b);
    const float r = wide ? a : b;
    const float angle = wide ? pi / 4 * (b / a) : pi / 2 - pi / 4 * (a / b);
    const float x = r * std::cos(angle), y = r * std::sin(angle);
    return {x, y, std::sqrt(std::max(0.0F, 1 - x * x - y * y))};
}

}  // namespace afterglow
