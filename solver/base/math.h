#pragma once

// The only place that includes GLM: vector types and the few helpers that every room shares.

#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace afterglow {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Mat4 = glm::mat4;
using Quat = glm::quat;  ///< unit length unless said otherwise; constructor order (w, x, y, z)
using Rgb = glm::vec3;   ///< linear red, green, blue (Rec. 709 primaries)

/// Elements refer to each other by index, never by pointer.
using Index = std::uint32_t;
inline constexpr Index no_index = std::numeric_limits<Index>::max();

inline constexpr float pi = 3.14159265358979323846F;

/// Largest of the three channels.
inline float max_channel(const Rgb& c) {
    return c.r > c.g ? (c.r > c.b ? c.r : c.b) : (c.g > c.b ? c.g : c.b);
}
/// True where no component is NaN or infinite.
inline bool is_finite(const Vec3& v) {
    // Subtracting a non-finite number from itself gives NaN, which equals nothing.
    return v.x - v.x == 0.0F && v.y - v.y == 0.0F && v.z - v.z == 0.0F;
}

/// Axis-aligned box; empty until something is added.
struct Box {
    Vec3 low{std::numeric_limits<float>::infinity()};
    Vec3 high{-std::numeric_limits<float>::infinity()};

    void add(const Vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    void add(const Box& b) {
        low = glm::min(low, b.low);
        high = glm::max(high, b.high);
    }
    [[nodiscard]] bool empty() const { return low.x > high.x; }
    [[nodiscard]] Vec3 centre() const { return 0.5F * (low + high); }
    [[nodiscard]] Vec3 extent() const { return high - low; }
    /// What touches counts.
    [[nodiscard]] bool holds(const Vec3& p) const {
        return glm::all(glm::lessThanEqual(low, p)) && glm::all(glm::lessThanEqual(p, high));
    }
    [[nodiscard]] bool meets(const Box& b) const {
        return glm::all(glm::lessThanEqual(low, b.high)) && glm::all(glm::lessThanEqual(b.low, high));
    }
};

/// Right-handed orthonormal frame around a unit normal: z is the normal.
/// Source: Duff et al. 2017, "Building an orthonormal basis, revisited" (branch-free, no pole).
struct Frame {
    Vec3 x, y, z;

    explicit Frame(const Vec3& normal) : z(normal) {
        const float sign = std::copysign(1.0F, normal.z);
        const float a = -1.0F / (sign + normal.z);
        const float b = normal.x * normal.y * a;
        x = Vec3(1.0F + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
        y = Vec3(b, sign + normal.y * normal.y * a, -normal.y);
    }
    [[nodiscard]] Vec3 to_world(const Vec3& local) const { return local.x * x + local.y * y + local.z * z; }
};

}  // namespace afterglow
