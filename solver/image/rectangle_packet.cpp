#include "solver/image/rectangle_packet.h"

#include <algorithm>
#include <cmath>

#include "solver/image/rectangle_choice.h"

namespace afterglow {

namespace {

constexpr std::size_t lanes = 16;

/// Below it the four angles it is the small difference of are not exact enough.
constexpr float least_solid_angle = 5e-3F;

// Written without branches, so that loops over lanes become packets. Errors stay below 4e-7.
// Source: Moshier's Cephes library.
float arc_sine_to_half(float x) {
    const float z = x * x;
    const float p =
        (((4.2163199048e-2F * z + 2.4181311049e-2F) * z + 4.5470025998e-2F) * z + 7.4953002686e-2F) * z +
        1.6666752422e-1F;
    return p * z * x + x;
}

float arc_cosine(float x) {
    const float size = std::min(std::abs(x), 1.0F);
    const bool steep = size > 0.5F;
    const float s = arc_sine_to_half(steep ? std::sqrt(0.5F * (1 - size)) : size);
    const float of_size = steep ? 2 * s : 0.5F * pi - s;
    return x < 0 ? pi - of_size : of_size;
}

struct SineCosine {
    float sine, cosine;
};

/// Of an angle in [0, 2π].
SineCosine sine_and_cosine(float angle) {
    const float turns = std::floor(angle * (2 / pi) + 0.5F);
    const auto quarter = static_cast<int>(turns);
    // π/2 in two parts, so that the difference keeps its bits.
    const float x = (angle - turns * 1.5703125F) - turns * 4.838267949e-4F;
    const float z = x * x;
    const float s = ((-1.9515295891e-4F * z + 8.3321608736e-3F) * z - 1.6666654611e-1F) * z * x + x;
    const float c =
        ((2.443315711809948e-5F * z - 1.388731625493765e-3F) * z + 4.166664568298827e-2F) * z * z - 0.5F * z +
        1;
    const bool swapped = (quarter & 1) != 0;
    const float sine = swapped ? c : s, cosine = swapped ? s : c;
    return {(quarter & 2) != 0 ? -sine : sine, ((quarter + 1) & 2) != 0 ? -cosine : cosine};
}

float hypotenuse(float a, float b) {
    return std::sqrt(a * a + b * b);
}

RectangleSight sight_of(const RectangleLight& light, const RectangleAxes& axes, const PointPacket& points,
                        std::size_t k) {
    return sight_of(light, axes, light.corner.x - points.x[k], light.corner.y - points.y[k],
                    light.corner.z - points.z[k], points.normal_x[k], points.normal_y[k], points.normal_z[k]);
}

}  // namespace

PacketFloats expected_of(const RectangleLight& light, const PointPacket& points) {
    const RectangleAxes axes(light);
    alignas(64) PacketFloats expected;
    for (std::size_t k = 0; k < lanes; ++k) {
        const RectangleSight sight = sight_of(light, axes, points, k);
        expected[k] = sight.expected(axes, corner_gains(sight, axes));
    }
    return expected;
}

void RectanglePacket::look(const RectangleLight& light, const PointPacket& points) {
    const RectangleAxes axes(light);
    const Vec3 centre = light.corner + 0.5F * (light.edge_u + light.edge_v);
    const float near_squared = RectangleView::near_squared(light);
    // Local, so that nothing it is made from can be part of it.
    RectanglePacket view;
    for (std::size_t k = 0; k < lanes; ++k) {
        const RectangleSight sight = sight_of(light, axes, points, k);
        const float x0 = sight.x0, y0 = sight.y0, height = sight.height;
        const float x1 = x0 + axes.length_u, y1 = y0 + axes.length_v;
        // Normals of the four planes through the viewpoint and an edge; only their heights matter.
        const float n0 = -y0 / hypotenuse(height, y0), n1 = x1 / hypotenuse(height, x1);
        const float n2 = y1 / hypotenuse(height, y1), n3 = -x0 / hypotenuse(height, x0);
        const float g2 = arc_cosine(-n2 * n3), g3 = arc_cosine(-n3 * n0);
        const float solid_angle = arc_cosine(-n0 * n1) + arc_cosine(-n1 * n2) + g2 + g3 - 2 * pi;
        const float cx = centre.x - points.x[k], cy = centre.y - points.y[k], cz = centre.z - points.z[k];
        const bool near =
            (static_cast<int>(cx * cx + cy * cy + cz * cz <= near_squared) & static_cast<int>(height > 0) &
             static_cast<int>(solid_angle > least_solid_angle)) != 0;
        const CornerWeights cosines = corner_cosines(sight, axes), gains = corner_gains(sight, axes);
        view.x0_[k] = x0;
        view.y0_[k] = y0;
        view.height_[k] = height;
        view.b0_[k] = n0;
        view.b1_[k] = n2;
        // No number where a point lies in an edge's plane and the rectangle's.
        view.k_[k] = near ? 2 * pi - g2 - g3 : 0.0F;
        view.solid_angle_[k] = near ? solid_angle : 0.0F;
        view.w00_[k] = near ? cosines.w00 : gains.w00;
        view.w10_[k] = near ? cosines.w10 : gains.w10;
        view.w01_[k] = near ? cosines.w01 : gains.w01;
        view.w11_[k] = near ? cosines.w11 : gains.w11;
    }
    *this = view;
}

void RectanglePacket::place(const RectangleLight& light, const PointPacket& points,
                            const std::array<Index, 16>& chosen, Index by, const PacketFloats& s,
                            const PacketFloats& t, PlacePacket& out) const {
    const RectangleAxes axes(light);
    // Local likewise.
    PlacePacket place;
    for (std::size_t k = 0; k < lanes; ++k) {
        const float x0 = x0_[k], y0 = y0_[k], height = height_[k], b0 = b0_[k];
        const float x1 = x0 + axes.length_u, y1 = y0 + axes.length_v;
        const bool near = solid_angle_[k] > 0;
        const BentPlace bent = bend(s[k], t[k], {w00_[k], w10_[k], w01_[k], w11_[k]});
        const auto [sine, cosine] = sine_and_cosine(bent.s * solid_angle_[k] + k_[k]);
        const float f = (cosine * b0 - b1_[k]) / sine;
        const float cu = std::min(1.0F, 1 / hypotenuse(f, b0));
        const float across = cu * height / std::sqrt(std::max(1e-30F, 1 - cu * cu));
        const float near_x = std::min(std::max(f < 0 ? -across : across, x0), x1);
        const float d = hypotenuse(near_x, height);
        const float h0 = y0 / hypotenuse(d, y0), h1 = y1 / hypotenuse(d, y1);
        const float h = h0 + bent.t * (h1 - h0);
        const float near_y = std::min(std::max(h * d / std::sqrt(std::max(1e-30F, 1 - h * h)), y0), y1);
        // In the rectangle's frame from its corner.
        const float u = near ? near_x - x0 : bent.s * axes.length_u;
        const float v = near ? near_y - y0 : bent.t * axes.length_v;
        const float x = light.corner.x + u * axes.x_axis.x + v * axes.y_axis.x;
        const float y = light.corner.y + u * axes.x_axis.y + v * axes.y_axis.y;
        const float z = light.corner.z + u * axes.x_axis.z + v * axes.y_axis.z;
        const float back_x = points.x[k] - x, back_y = points.y[k] - y, back_z = points.z[k] - z;
        const float squared = back_x * back_x + back_y * back_y + back_z * back_z;
        const float by_area = axes.area_m2() * std::max(0.0F, height) / (squared * std::sqrt(squared));
        place.x[k] = x;
        place.y[k] = y;
        place.z[k] = z;
        place.solid_angle[k] = (near ? solid_angle_[k] : by_area) / bent.density;
    }
    for (std::size_t k = 0; k < lanes; ++k) {
        const bool here = chosen[k] == by;
        out.x[k] = here ? place.x[k] : out.x[k];
        out.y[k] = here ? place.y[k] : out.y[k];
        out.z[k] = here ? place.z[k] : out.z[k];
        out.solid_angle[k] = here ? place.solid_angle[k] : out.solid_angle[k];
    }
}

}  // namespace afterglow
