#include "solver/scene/reflectance.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "solver/scene/enclosure.h"
#include "solver/scene/place.h"
#include "solver/scene/world.h"

namespace afterglow {

namespace {

/// Which materials reflect all light of a channel at some time.
std::vector<bool> bright_materials(const Scene& scene) {
    std::vector<bool> bright;
    for (const Material& material : scene.materials) bright.push_back(max_channel(material.reflectance) >= 1);
    for (const auto& track : scene.tracks.material_reflectance)
        if (std::any_of(track.keys.begin(), track.keys.end(),
                        [](const auto& key) { return max_channel(key.value) >= 1; }))
            bright[track.target] = true;
    return bright;
}

/// A point just in front of the first shining triangle.
std::optional<Vec3> in_front_of_emitter(const World& world) {
    for (const Body& body : world.bodies)
        for (const Triangle& triangle : body.triangles) {
            if (!(max_channel(world.materials[triangle.material].emission) > 0)) continue;
            const auto& [a, b, c] = triangle.vertices;
            const Vec3 centroid = (body.positions[a] + body.positions[b] + body.positions[c]) / 3.0F;
            const Vec3 normal =
                glm::cross(body.positions[b] - body.positions[a], body.positions[c] - body.positions[a]);
            const float size = std::sqrt(glm::length(normal));
            return body.path.at(0).point(centroid + 1e-3F * size * glm::normalize(normal));
        }
    return std::nullopt;
}

bool is_closed(const World& world) {
    if (const auto point = in_front_of_emitter(world)) return is_enclosed(world, *point);
    if (!world.lights.empty()) return is_enclosed(world, world.lights.front().path.at(0).translation);
    if (!world.cameras.empty()) return is_enclosed(world, world.cameras.front().path.at(0).translation);
    return false;
}

/// The first material in `bright` that an untextured triangle of the world is made of.
std::optional<Index> first_in_use(const World& world, const std::vector<bool>& bright) {
    for (const Body& body : world.bodies)
        for (const Triangle& triangle : body.triangles)
            if (bright[triangle.material] && world.materials[triangle.material].texture == no_index)
                return triangle.material;
    return std::nullopt;
}

void reject_if_closed(const Scene& scene, const std::vector<bool>& bright) {
    const World world = assemble(scene);
    const auto material = first_in_use(world, bright);
    if (!material || !is_closed(world)) return;
    throw Error(ErrorKind::cannot_converge, place_of("material", scene.materials[*material].name, *material),
                "reflects all light (reflectance 1 or more) in a closed scene, where light would never end; "
                "white paint reflects about 0.8");
}

std::string list_of(const Scene& scene, const std::vector<bool>& bright) {
    constexpr int shown = 5;
    std::string out;
    int count = 0;
    for (std::size_t m = 0; m < bright.size(); ++m) {
        if (!bright[m]) continue;
        if (count < shown) out += (count == 0 ? "" : ", ") + place_of("material", scene.materials[m].name, m);
        ++count;
    }
    return count > shown ? out + " and " + std::to_string(count - shown) + " more" : out;
}

}  // namespace

void limit_reflectance(Scene& scene) {
    const auto bright = bright_materials(scene);
    if (std::find(bright.begin(), bright.end(), true) == bright.end()) return;

    reject_if_closed(scene, bright);
    const auto limited = [](const Rgb& value) {
        Rgb out = value;
        for (int c = 0; c < 3; ++c)
            if (out[c] >= 1) out[c] = largest_reflectance;
        return out;
    };
    for (auto& material : scene.materials) material.reflectance = limited(material.reflectance);
    for (auto& track : scene.tracks.material_reflectance)
        for (auto& key : track.keys) key.value = limited(key.value);
    scene.warnings.push_back(
        {list_of(scene, bright), "a reflectance of 1 or more, which no surface has, is taken as 0.99"});
}

}  // namespace afterglow
