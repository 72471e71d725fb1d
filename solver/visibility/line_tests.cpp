#include "solver/visibility/line_tests.h"

#include <algorithm>
#include <cmath>

namespace afterglow {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

/// A slope so small that no line of a scene leaves a box by it, but whose inverse is finite.
constexpr float least_slope = 1e-18F;

float inverse_of(float slope) {
    return 1 / (std::abs(slope) < least_slope ? std::copysign(least_slope, slope) : slope);
}

}  // namespace

void LinePacket::prepare() {
    for (std::size_t k = rays.count; k < 16; ++k) rays.set(k, {Vec3(0), Vec3(0, 0, 1), -1});
    for (std::size_t k = 0; k < 16; ++k) {
        inverse_x[k] = inverse_of(rays.direction_x[k]);
        inverse_y[k] = inverse_of(rays.direction_y[k]);
        inverse_z[k] = inverse_of(rays.direction_z[k]);
    }
}

void to_body(const RayPacket& rays, const Pose& pose, LinePacket& out) {
    const glm::mat3 back = glm::mat3_cast(glm::conjugate(pose.rotation));
    const Vec3 x = back[0], y = back[1], z = back[2], at = pose.translation;
    out.rays.count = rays.count;
    out.rays.far = rays.far;
    for (std::size_t k = 0; k < 16; ++k) {
        const float px = rays.origin_x[k] - at.x, py = rays.origin_y[k] - at.y, pz = rays.origin_z[k] - at.z;
        out.rays.origin_x[k] = x.x * px + y.x * py + z.x * pz;
        out.rays.origin_y[k] = x.y * px + y.y * py + z.y * pz;
        out.rays.origin_z[k] = x.z * px + y.z * py + z.z * pz;
        const float dx = rays.direction_x[k], dy = rays.direction_y[k], dz = rays.direction_z[k];
        out.rays.direction_x[k] = x.x * dx + y.x * dy + z.x * dz;
        out.rays.direction_y[k] = x.y * dx + y.y * dy + z.y * dz;
        out.rays.direction_z[k] = x.z * dx + y.z * dy + z.z * dz;
    }
    out.prepare();
}

std::uint32_t lanes_through(const LinePacket& lines, const Box& box) {
    const RayPacket& rays = lines.rays;
    alignas(64) std::array<std::int32_t, 16> meets;
    for (std::size_t k = 0; k < 16; ++k) {
        const float x0 = (box.low.x - rays.origin_x[k]) * lines.inverse_x[k];
        const float x1 = (box.high.x - rays.origin_x[k]) * lines.inverse_x[k];
        const float y0 = (box.low.y - rays.origin_y[k]) * lines.inverse_y[k];
        const float y1 = (box.high.y - rays.origin_y[k]) * lines.inverse_y[k];
        const float z0 = (box.low.z - rays.origin_z[k]) * lines.inverse_z[k];
        const float z1 = (box.high.z - rays.origin_z[k]) * lines.inverse_z[k];
        const float enters = std::max(std::max(std::min(x0, x1), std::min(y0, y1)), std::min(z0, z1));
        const float leaves = std::min(std::min(std::max(x0, x1), std::max(y0, y1)), std::max(z0, z1));
        // A few roundings may part what touches.
        const float slack = 4e-7F * (std::abs(enters) + std::abs(leaves));
        meets[k] = static_cast<int>(enters <= leaves + slack) & static_cast<int>(leaves >= -slack) &
                   static_cast<int>(enters <= rays.far[k] + slack);
    }
    std::uint32_t mask = 0;
    for (std::size_t k = 0; k < rays.count; ++k) mask |= static_cast<std::uint32_t>(meets[k]) << k;
    return mask;
}

// Source: Duff et al. 2017, "Building an orthonormal basis, revisited".
LineAxes::LineAxes(const RayPacket& rays) {
    for (std::size_t k = 0; k < 16; ++k) {
        const float x = rays.direction_x[k], y = rays.direction_y[k], z = rays.direction_z[k];
        const float sign = std::copysign(1.0F, z);
        const float a = -1 / (sign + z), b = x * y * a;
        u_x[k] = 1 + sign * x * x * a;
        u_y[k] = sign * b;
        u_z[k] = -sign * x;
        v_x[k] = b;
        v_y[k] = sign + y * y * a;
        v_z[k] = -y;
    }
}

void meet(const RayPacket& rays, const LineAxes& axes, const LineFace& face,
          std::array<float, 16>& distance) {
    for (std::size_t k = 0; k < 16; ++k) {
        const float ox = rays.origin_x[k], oy = rays.origin_y[k], oz = rays.origin_z[k];
        const float ax = face.a.x - ox, ay = face.a.y - oy, az = face.a.z - oz;
        const float bx = face.b.x - ox, by = face.b.y - oy, bz = face.b.z - oz;
        const float cx = face.c.x - ox, cy = face.c.y - oy, cz = face.c.z - oz;
        const float au = axes.u_x[k] * ax + axes.u_y[k] * ay + axes.u_z[k] * az;
        const float av = axes.v_x[k] * ax + axes.v_y[k] * ay + axes.v_z[k] * az;
        const float bu = axes.u_x[k] * bx + axes.u_y[k] * by + axes.u_z[k] * bz;
        const float bv = axes.v_x[k] * bx + axes.v_y[k] * by + axes.v_z[k] * bz;
        const float cu = axes.u_x[k] * cx + axes.u_y[k] * cy + axes.u_z[k] * cz;
        const float cv = axes.v_x[k] * cx + axes.v_y[k] * cy + axes.v_z[k] * cz;
        // Rounding keeps the order of the two products, hence the sign of their difference or zero.
        const float ab = au * bv - av * bu, bc = bu * cv - bv * cu, ca = cu * av - cv * au;
        const float towards = rays.direction_x[k] * face.normal.x + rays.direction_y[k] * face.normal.y +
                              rays.direction_z[k] * face.normal.z;
        const float height = ax * face.normal.x + ay * face.normal.y + az * face.normal.z;
        const float least = std::min(std::min(ab, bc), ca), most = std::max(std::max(ab, bc), ca);
        const float at = height / towards;
        const bool within = (static_cast<int>(least >= 0) | static_cast<int>(most <= 0)) != 0;
        // A line in the face's plane meets nothing: its `at` is infinite or no number at all.
        const bool ahead = (static_cast<int>(towards != 0) & static_cast<int>(at >= 0)) != 0;
        distance[k] = (static_cast<int>(within) & static_cast<int>(ahead)) != 0 ? at : infinite;
    }
}

}  // namespace afterglow
