#include "solver/visibility/lamps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace afterglow {

bool is_emitter(const World& world, const PatchMesh& mesh, Index patch) {
    const Material& material = world.materials[mesh.material(patch)];
    return max_channel(material.emission) > 0 &&
           (mesh.side[patch] == Side::front || material.shines == Material::Shines::both);
}

Lamps find_lamps(const World& world, const PatchMesh& mesh, const LampConfig& config) {
    const float total = std::accumulate(mesh.area_m2.begin(), mesh.area_m2.end(), 0.0F);
    const auto emission_of = [&](Index p) { return max_channel(world.materials[mesh.material(p)].emission); };
    std::map<std::pair<Index, Side>, std::vector<Index>> sides;
    float power = 0;
    for (Index p = 0; p < mesh.size(); ++p) {
        if (!is_emitter(world, mesh, p)) continue;
        sides[{mesh.surface[p], mesh.side[p]}].push_back(p);
        power += mesh.area_m2[p] * emission_of(p);
    }

    Lamps out;
    out.lamp_of_patch.assign(mesh.size(), no_index);
    for (auto& [key, patches] : sides) {
        Lamp lamp;
        lamp.body = mesh.body[patches.front()];
        Box box;
        for (const Index p : patches) {
            lamp.area_m2 += mesh.area_m2[p];
            const float reach = 0.5F * std::max(glm::length(mesh.edge_u[p]), glm::length(mesh.edge_v[p]));
            box.add(mesh.centre[p] - Vec3(reach));
            box.add(mesh.centre[p] + Vec3(reach));
        }
        if (lamp.area_m2 > config.largest_share * total) continue;
        if (emission_of(patches.front()) * total < config.least_contrast * power) continue;
        lamp.centre = box.centre();
        lamp.radius_m = 0.5F * glm::length(box.extent());
        for (const Index p : patches) {
            out.lamp_of_patch[p] = static_cast<Index>(out.list.size());
            out.patches.push_back(p);
        }
        lamp.patches = std::move(patches);
        out.list.push_back(std::move(lamp));
    }
    float sum = 0;
    for (const Index p : out.patches) out.cumulative_power.push_back(sum += mesh.area_m2[p] * emission_of(p));
    for (float& share : out.cumulative_power) share /= sum;
    if (!out.cumulative_power.empty()) out.cumulative_power.back() = 1;
    return out;
}

bool is_near(const Lamp& lamp, const Vec3& point, const LampConfig& config) {
    const float distance = std::max(0.0F, glm::length(point - lamp.centre) - lamp.radius_m);
    return lamp.area_m2 > config.near_share * 2 * pi * distance * distance;
}

}  // namespace afterglow
