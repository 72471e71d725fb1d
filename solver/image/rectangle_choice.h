#pragma once

#include <algorithm>
#include <cmath>

#include "solver/image/rectangle_light.h"

namespace afterglow {

// How points of a rectangle are chosen in proportion, nearly, to what they give, so that lines from one point
// of a surface bring nearly the same light and only what stands between makes noise. All functions are pure
// and free of branches: in a loop over lanes they become packets.

/// Something by corner of a rectangle: at the corner itself, one edge_u on, one edge_v on, and opposite.
struct CornerWeights {
    float w00 = 0, w10 = 0, w01 = 0, w11 = 0;
};

/// A rectangle's axes.
struct RectangleAxes {
    Vec3 x_axis, y_axis, normal;  ///< unit; it shines along the normal
    float length_u, length_v;     ///< metres

    explicit RectangleAxes(const RectangleLight& light)
        : length_u(glm::length(light.edge_u)), length_v(glm::length(light.edge_v)) {
        x_axis = light.edge_u / length_u;
        y_axis = light.edge_v / length_v;
        normal = glm::cross(x_axis, y_axis);
    }
    [[nodiscard]] float area_m2() const { return length_u * length_v; }
};

/// What a point of a surface with a unit normal sees of a rectangle: heights in metres, x and y along the
/// rectangle's axes.
struct RectangleSight {
    float x0, y0;            ///< of the rectangle's corner
    float height;            ///< of the point above the rectangle's plane
    float along;             ///< of the corner above the point's horizon
    float along_u, along_v;  ///< by how much that rises along the edges

    /// cos · cos / distance² of the place at shares (u, v) of the edges: what a square metre there gives,
    /// times π, per W/m² of radiosity.
    [[nodiscard]] float gain(const RectangleAxes& axes, float u, float v) const {
        const float x = x0 + u * axes.length_u, y = y0 + v * axes.length_v;
        const float squared = x * x + y * y + height * height + 1e-6F * axes.area_m2();
        return std::max(0.0F, height) * std::max(0.0F, along + u * along_u + v * along_v) /
               (squared * squared);
    }
    /// The cosine at the point's surface of the line to that place.
    [[nodiscard]] float cosine(const RectangleAxes& axes, float u, float v) const {
        const float x = x0 + u * axes.length_u, y = y0 + v * axes.length_v;
        return std::max(0.0F, along + u * along_u + v * along_v) /
               std::sqrt(x * x + y * y + height * height + 1e-6F * axes.area_m2());
    }
    /// About what the whole rectangle gives if nothing stands between, times π, per W/m²: the mean of five
    /// places, which a quadratic function has. Nearer than a diagonal it may be far too much or too little.
    [[nodiscard]] float expected(const RectangleAxes& axes, const CornerWeights& gains) const {
        return axes.area_m2() / 12 *
               (gains.w00 + gains.w10 + gains.w01 + gains.w11 + 8 * gain(axes, 0.5F, 0.5F));
    }
};

/// From the corner relative to the point, and the point's unit normal, by component.
inline RectangleSight sight_of(const RectangleLight& light, const RectangleAxes& axes, float x, float y,
                               float z, float normal_x, float normal_y, float normal_z) {
    RectangleSight out;
    out.x0 = x * axes.x_axis.x + y * axes.x_axis.y + z * axes.x_axis.z;
    out.y0 = x * axes.y_axis.x + y * axes.y_axis.y + z * axes.y_axis.z;
    out.height = -(x * axes.normal.x + y * axes.normal.y + z * axes.normal.z);
    out.along = x * normal_x + y * normal_y + z * normal_z;
    out.along_u = light.edge_u.x * normal_x + light.edge_u.y * normal_y + light.edge_u.z * normal_z;
    out.along_v = light.edge_v.x * normal_x + light.edge_v.y * normal_y + light.edge_v.z * normal_z;
    return out;
}

inline RectangleSight sight_of(const RectangleLight& light, const RectangleAxes& axes, const Vec3& from,
                               const Vec3& normal) {
    const Vec3 to = light.corner - from;
    return sight_of(light, axes, to.x, to.y, to.z, normal.x, normal.y, normal.z);
}

inline CornerWeights corner_gains(const RectangleSight& sight, const RectangleAxes& axes) {
    return {sight.gain(axes, 0, 0), sight.gain(axes, 1, 0), sight.gain(axes, 0, 1), sight.gain(axes, 1, 1)};
}

inline CornerWeights corner_cosines(const RectangleSight& sight, const RectangleAxes& axes) {
    return {sight.cosine(axes, 0, 0), sight.cosine(axes, 1, 0), sight.cosine(axes, 0, 1),
            sight.cosine(axes, 1, 1)};
}

/// How often a rectangle is chosen beside others: by what it is expected to give, held to what a bound of it
/// says, which is true to a factor near by, where five places say little, and keeps it possible where they
/// lie below a horizon. `bound`: area · cosine of the highest part / distance_squared, which is no less than
/// `radius_squared`, of a ball around it.
inline float weight_of(float expected, float bound, float distance_squared, float radius_squared) {
    const float nearness = radius_squared / distance_squared;
    const float least = std::max(0.02F, 0.5F * nearness * nearness);
    return std::min(std::max(expected, least * bound), 2 * bound);
}

/// (s, t) bent towards corners of more weight; how densely places lie there, 1 on average.
struct BentPlace {
    float s, t, density;
};

namespace detail {

/// In [0,1), in proportion to a function that is linear between its ends.
inline float bent(float s, float at0, float at1) {
    const float squared = at0 * at0 + s * (at1 * at1 - at0 * at0);
    return std::min(s * (at0 + at1) / (at0 + std::sqrt(std::max(0.0F, squared))), 0x1.fffffep-1F);
}

}  // namespace detail

/// Uniform (s, t) in [0,1)² bent in proportion to the weights, interpolated, and at least a tenth of their
/// mean, so that places are chosen also where all corners lie below a horizon. Source: Pharr, Jakob and
/// Humphreys, "Physically Based Rendering", 4th edition, section 6.5.
inline BentPlace bend(float s, float t, const CornerWeights& w) {
    constexpr float least = 0.1F;
    const float sum = w.w00 + w.w10 + w.w01 + w.w11;
    const float scale = 4 * (1 - least) / std::max(sum, 1e-30F);
    const float w00 = least + scale * w.w00, w10 = least + scale * w.w10, w01 = least + scale * w.w01,
                w11 = least + scale * w.w11;
    BentPlace out;
    out.s = detail::bent(s, w00 + w01, w10 + w11);
    const float low = w00 + out.s * (w10 - w00), high = w01 + out.s * (w11 - w01);
    out.t = detail::bent(t, low, high);
    out.density = 4 * (low + out.t * (high - low)) / (w00 + w10 + w01 + w11);
    return out;
}

}  // namespace afterglow
