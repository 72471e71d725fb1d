#include "solver/image/direct_light.h"

#include <algorithm>
#include <cmath>

#include "solver/image/rectangle_choice.h"

namespace afterglow {

namespace {

/// The rectangle that a lamp's patches fill, in its body's frame, if they do.
std::optional<RectangleLight> rectangle_of(const PatchMesh& mesh, const Lamp& lamp) {
    const Index first = lamp.patches.front();
    const SurfaceGrid& grid = mesh.grids[mesh.surface[first]];
    if (grid.cells_u == 0) return std::nullopt;
    for (const Index p : lamp.patches)
        if (mesh.first_fragment[p] != mesh.first_fragment[p + 1]) return std::nullopt;
    const auto edge = [](const Vec3& per_metre, int cells) {
        return static_cast<float>(cells) / glm::dot(per_metre, per_metre) * per_metre;
    };
    RectangleLight out{grid.origin, edge(grid.per_metre_u, grid.cells_u),
                       edge(grid.per_metre_v, grid.cells_v)};
    const Vec3 across = glm::cross(out.edge_u, out.edge_v);
    if (std::abs(glm::length(across) - lamp.area_m2) > 1e-3F * lamp.area_m2) return std::nullopt;
    if (glm::dot(across, mesh.normal[first]) < 0) std::swap(out.edge_u, out.edge_v);
    return out;
}

}  // namespace

DirectLight::DirectLight(const PatchMesh& mesh, const Lamps& lamps, const RayCaster& placed,
                         std::span<const Rgb> emission)
    : mesh_(&mesh), covered_(mesh.surfaces.list.size(), {false, false}) {
    for (const Lamp& lamp : lamps.list) {
        // A lamp is all patches of one side of a surface.
        const Index first = lamp.patches.front();
        covered_[mesh.surface[first]][static_cast<std::size_t>(mesh.side[first])] = true;
        Emitter emitter;
        emitter.emission = emission[first];
        if (max_channel(emitter.emission) <= 0) continue;
        emitter.pose = placed.pose(lamp.body);
        emitter.centre = emitter.pose.point(lamp.centre);
        emitter.radius_m = lamp.radius_m;
        emitter.area_m2 = lamp.area_m2;
        emitter.rectangle = rectangle_of(mesh, lamp);
        if (auto& r = emitter.rectangle) {
            *r = {emitter.pose.point(r->corner), emitter.pose.direction(r->edge_u),
                  emitter.pose.direction(r->edge_v)};
        } else {
            emitter.patches = lamp.patches;
            float sum = 0;
            for (const Index p : lamp.patches)
                emitter.cumulative_share.push_back(sum += mesh.area_m2[p] / lamp.area_m2);
            emitter.cumulative_share.back() = 1;
        }
        emitters_.push_back(std::move(emitter));
    }
}

bool DirectLight::covers(const Hit& hit) const {
    const Index surface = mesh_->surfaces.of_triangle[hit.body][hit.triangle];
    return covered_[surface][static_cast<std::size_t>(hit.side)];
}

/// How often a lamp is chosen, beside others.
float DirectLight::weight(const Emitter& emitter, const Vec3& point, const Vec3& normal) {
    const Vec3 to = emitter.centre - point;
    const float squared = std::max(glm::dot(to, to), emitter.radius_m * emitter.radius_m);
    const float distance = std::sqrt(squared);
    // The part of the ball around the lamp that rises above the point's horizon.
    const float cosine = std::min(1.0F, (glm::dot(to, normal) + emitter.radius_m) / distance);
    if (cosine <= 0) return 0;
    const float bound = emitter.area_m2 * cosine / squared, most = max_channel(emitter.emission);
    if (!emitter.rectangle) return most * bound;
    const RectangleLight& light = *emitter.rectangle;
    const RectangleAxes axes(light);
    const RectangleSight sight = sight_of(light, axes, point, normal);
    if (sight.height <= 0) return 0;
    return most * weight_of(sight.expected(axes, corner_gains(sight, axes)), bound, squared,
                            emitter.radius_m * emitter.radius_m);
}

DirectLight::Place DirectLight::place_on_patches(const Emitter& emitter, const Vec3& from, float choice,
                                                 float s, float t) const {
    const auto& shares = emitter.cumulative_share;
    const auto k =
        static_cast<std::size_t>(std::upper_bound(shares.begin(), shares.end() - 1, choice) - shares.begin());
    const PatchPoint on = mesh_->point_on(emitter.patches[k], s, t);
    const Vec3 position = emitter.pose.point(on.position);
    const Vec3 back = from - position;
    const float squared = glm::dot(back, back);
    if (!(squared > 0)) return {position, 0};
    const float facing = glm::dot(emitter.pose.direction(on.normal), back);
    return {position, emitter.area_m2 * std::max(0.0F, facing) / (squared * std::sqrt(squared))};
}

LightSample DirectLight::sample(const Vec3& point, const Vec3& normal, float choice, float s, float t) const {
    std::vector<float> weights;
    float sum = 0;
    for (const Emitter& emitter : emitters_) sum += weights.emplace_back(weight(emitter, point, normal));
    if (!(sum > 0)) return {};
    float left = choice * sum;
    const Emitter* chosen = nullptr;
    float of_chosen = 0;
    for (std::size_t e = 0; e < emitters_.size(); ++e) {
        if (weights[e] <= 0) continue;
        chosen = &emitters_[e];
        of_chosen = weights[e];
        if (left < of_chosen) break;
        left -= of_chosen;
    }
    // What is left of `choice` within the chosen lamp is uniform again.
    const float rest = std::min(left / of_chosen, 1.0F);
    Place place;
    if (chosen->rectangle) {
        const RectanglePoint on = point_for(*chosen->rectangle, point, normal, s, t);
        place = {on.position, on.solid_angle};
    } else {
        place = place_on_patches(*chosen, point, rest, s, t);
    }
    const Vec3 across = place.position - point;
    LightSample out;
    out.distance_m = glm::length(across);
    if (!(out.distance_m > 0)) return {};
    out.direction = across / out.distance_m;
    const float cosine = std::max(0.0F, glm::dot(out.direction, normal));
    out.irradiance = chosen->emission * (cosine * place.solid_angle * sum / (pi * of_chosen));
    return out;
}

bool DirectLight::shines_like(const DirectLight& other) const {
    const auto same = [](const Emitter& a, const Emitter& b) {
        return a.emission == b.emission && a.pose == b.pose && a.centre == b.centre;
    };
    return std::equal(emitters_.begin(), emitters_.end(), other.emitters_.begin(), other.emitters_.end(),
                      same);
}

std::vector<Box> DirectLight::boxes() const {
    std::vector<Box> out;
    for (const Emitter& emitter : emitters_) {
        Box box;
        if (const auto& r = emitter.rectangle) {
            for (const Vec3& corner :
                 {r->corner, r->corner + r->edge_u, r->corner + r->edge_v, r->corner + r->edge_u + r->edge_v})
                box.add(corner);
        } else {
            box.add(emitter.centre - Vec3(emitter.radius_m));
            box.add(emitter.centre + Vec3(emitter.radius_m));
        }
        out.push_back(box);
    }
    return out;
}

}  // namespace afterglow
