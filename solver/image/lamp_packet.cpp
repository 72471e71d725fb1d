#include "solver/image/lamp_packet.h"

#include <algorithm>
#include <cmath>

#include "solver/image/rectangle_choice.h"

namespace afterglow {

namespace {

constexpr std::size_t lanes = 16;

}  // namespace

LampPacket::LampPacket(const DirectLight& direct) : direct_(&direct), sights_(direct.emitters().size()) {}

void LampPacket::set(std::size_t lane, const Vec3& point, const Vec3& normal) {
    points_.x[lane] = point.x;
    points_.y[lane] = point.y;
    points_.z[lane] = point.z;
    points_.normal_x[lane] = normal.x;
    points_.normal_y[lane] = normal.y;
    points_.normal_z[lane] = normal.z;
}

void LampPacket::look() {
    sum_.fill(0);
    for (std::size_t e = 0; e < sights_.size(); ++e) {
        look_at(direct_->emitters()[e], sights_[e]);
        for (std::size_t lane = 0; lane < lanes; ++lane) sum_[lane] += sights_[e].weight[lane];
    }
}

/// As DirectLight::weight, for all lanes.
void LampPacket::look_at(const DirectLight::Emitter& emitter, Sight& sight) const {
    const Vec3 centre = emitter.centre;
    const float radius = emitter.radius_m, area = emitter.area_m2, most = max_channel(emitter.emission);
    // What is not a rectangle is chosen by its bound alone, and shines everywhere.
    alignas(64) PacketFloats expected{};
    const bool is_rectangle = emitter.rectangle.has_value();
    float behind = -1;
    Vec3 plane(0);
    if (const auto& r = emitter.rectangle) {
        expected = expected_of(*r, points_);
        plane = glm::cross(r->edge_u, r->edge_v);
        behind = glm::dot(plane, r->corner);
    }
    // Local, so that nothing it is made from can be one of them.
    alignas(64) PacketFloats weights;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        const float x = centre.x - points_.x[lane], y = centre.y - points_.y[lane],
                    z = centre.z - points_.z[lane];
        const float squared = std::max(x * x + y * y + z * z, radius * radius);
        const float along =
            x * points_.normal_x[lane] + y * points_.normal_y[lane] + z * points_.normal_z[lane];
        const float cosine = std::min(1.0F, (along + radius) / std::sqrt(squared));
        const float ahead =
            plane.x * points_.x[lane] + plane.y * points_.y[lane] + plane.z * points_.z[lane] - behind;
        const float bound = area * cosine / squared;
        const float weight =
            most * (is_rectangle ? weight_of(expected[lane], bound, squared, radius * radius) : bound);
        weights[lane] = (static_cast<int>(cosine > 0) & static_cast<int>(ahead > 0)) != 0 ? weight : 0.0F;
    }
    sight.weight = weights;
    sight.is_viewed = false;
}

/// The lamp of each lane, and how far into its part of [0,1) the choice was.
void LampPacket::choose(const PacketFloats& choice, std::array<Index, 16>& chosen, PacketFloats& rest) {
    alignas(64) PacketFloats left;
    alignas(64) std::array<std::int32_t, lanes> done{};
    chosen.fill(0);
    weight_.fill(0);
    rest.fill(0);
    for (std::size_t lane = 0; lane < lanes; ++lane) left[lane] = choice[lane] * sum_[lane];
    for (std::size_t e = 0; e < sights_.size(); ++e) {
        const PacketFloats& weight = sights_[e].weight;
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const float w = weight[lane];
            const bool take = (done[lane] == 0) & (w > 0);
            chosen[lane] = take ? static_cast<Index>(e) : chosen[lane];
            weight_[lane] = take ? w : weight_[lane];
            rest[lane] = take ? left[lane] : rest[lane];
            done[lane] |= static_cast<std::int32_t>(take & (left[lane] < w));
            left[lane] -= take ? w : 0.0F;
        }
    }
    // Rounding can carry a choice past the last lamp.
    for (std::size_t lane = 0; lane < lanes; ++lane)
        rest[lane] = std::min(rest[lane] / weight_[lane], 0x1.fffffep-1F);
}

void LampPacket::place_on_rectangle(Index emitter, const std::array<Index, 16>& chosen, const PacketFloats& s,
                                    const PacketFloats& t) {
    const RectangleLight& light = *direct_->emitters()[emitter].rectangle;
    Sight& sight = sights_[emitter];
    if (!sight.is_viewed) sight.view.look(light, points_);
    sight.is_viewed = true;
    sight.view.place(light, points_, chosen, emitter, s, t, places_);
}

void LampPacket::place_on_patches(Index emitter, std::size_t lane, float choice, float s, float t) {
    const Vec3 from(points_.x[lane], points_.y[lane], points_.z[lane]);
    const DirectLight::Place place =
        direct_->place_on_patches(direct_->emitters()[emitter], from, choice, s, t);
    places_.x[lane] = place.position.x;
    places_.y[lane] = place.position.y;
    places_.z[lane] = place.position.z;
    places_.solid_angle[lane] = place.solid_angle;
}

void LampPacket::sample(const PacketFloats& choice, const PacketFloats& s, const PacketFloats& t,
                        LampPacketSamples& out) {
    alignas(64) PacketFloats rest;
    choose(choice, out.emitter, rest);
    for (Index e = 0; e < sights_.size(); ++e) {
        std::uint32_t here = 0;
        for (std::size_t lane = 0; lane < lanes; ++lane) here |= (out.emitter[lane] == e ? 1U : 0U) << lane;
        if (here == 0) continue;
        if (direct_->emitters()[e].rectangle) {
            place_on_rectangle(e, out.emitter, s, t);
            continue;
        }
        for (std::size_t lane = 0; lane < lanes; ++lane)
            if (((here >> lane) & 1U) != 0 && weight_[lane] > 0)
                place_on_patches(e, lane, rest[lane], s[lane], t[lane]);
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        const float x = places_.x[lane] - points_.x[lane], y = places_.y[lane] - points_.y[lane],
                    z = places_.z[lane] - points_.z[lane];
        const float distance = std::sqrt(x * x + y * y + z * z), inverse = 1 / distance;
        out.direction_x[lane] = x * inverse;
        out.direction_y[lane] = y * inverse;
        out.direction_z[lane] = z * inverse;
        out.distance_m[lane] = distance;
        const float along =
            x * points_.normal_x[lane] + y * points_.normal_y[lane] + z * points_.normal_z[lane];
        const float cosine = std::max(0.0F, along * inverse);
        const float share = cosine * places_.solid_angle[lane] * sum_[lane] / (pi * weight_[lane]);
        // Where no lamp gives anything, or the point lies on one, this is not a number.
        out.share[lane] = share > 0 && weight_[lane] > 0 ? share : 0.0F;
    }
}

}  // namespace afterglow
