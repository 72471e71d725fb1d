#include "solver/scene/world_edits.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "solver/base/error.h"
#include "solver/scene/furniture.h"
#include "solver/scene/keys.h"
#include "solver/scene/moments.h"
#include "solver/scene/named.h"

namespace afterglow {

namespace {

void require_light(const Rgb& value, float limit, const char* field, const char* rule) {
    if (!is_finite(value) || value.r < 0 || value.g < 0 || value.b < 0 || max_channel(value) >= limit)
        throw Error(ErrorKind::invalid_input, field, rule);
}

void require_path(const Path& path) {
    if (path.keys.empty()) throw Error(ErrorKind::invalid_input, "path", "needs at least one key");
    for (std::size_t k = 0; k < path.keys.size(); ++k) {
        const Key<Pose>& key = path.keys[k];
        const std::string place = "path key " + std::to_string(k);
        if (!std::isfinite(key.time_s) || !is_finite(key.value.translation) ||
            !(std::abs(glm::length(key.value.rotation) - 1) < 1e-3F))
            throw Error(ErrorKind::invalid_input, place, "must be finite, its rotation of unit length");
        if (k > 0 && key.time_s < path.keys[k - 1].time_s)
            throw Error(ErrorKind::invalid_input, place, "must not come before the one before it");
    }
}

template <class Tracks>
void drop_track(Tracks& tracks, Index target) {
    std::erase_if(tracks, [&](const auto& track) { return track.target == target; });
}

}  // namespace

Index set_emission(World& world, const std::string& material, const Rgb& emission) {
    const Index edited = index_named(world.materials, 0, material, "material");
    require_light(emission, 1e6F, "emission", "must lie in [0, 1e6) W/m²/sr");
    world.materials[edited].emission = emission;
    drop_track(world.material_emission, edited);
    return edited;
}

std::vector<Index> lamps_named(const World& world, const std::string& name) {
    std::vector<Index> found;
    for (Index l = 0; l < world.lights.size(); ++l)
        if (world.lights[l].light.name == name) found.push_back(l);
    if (!found.empty()) return found;
    std::set<std::string> listed;
    std::string names;
    for (const PlacedLight& placed : world.lights)
        if (listed.insert(placed.light.name).second)
            names += (names.empty() ? "there are: " : ", ") + placed.light.name;
    throw Error(ErrorKind::not_found, "lamp",
                "there is no lamp \"" + name + "\"; " + (names.empty() ? "the scene has none" : names));
}

Index set_intensity(World& world, const std::string& lamp, const Rgb& intensity) {
    const std::vector<Index> lamps = lamps_named(world, lamp);
    require_light(intensity, 1e6F, "intensity", "must lie in [0, 1e6) W/sr, of a directional lamp W/m²");
    for (const Index edited : lamps) world.lights[edited].light.intensity = intensity;
    return lamps.front();
}

Index set_reflectance(World& world, const std::string& material, const Rgb& reflectance) {
    const Index edited = index_named(world.materials, 0, material, "material");
    require_light(reflectance, 1, "reflectance", "must lie in [0, 1)");
    world.materials[edited].reflectance = reflectance;
    drop_track(world.material_reflectance, edited);
    return edited;
}

Index set_path(World& world, const std::string& actor, double from_s, const Path& path) {
    const Index edited = index_named(world.bodies, furniture + 1, actor, "actor");
    require_path(path);
    if (!std::isfinite(from_s)) throw Error(ErrorKind::invalid_input, "from", "must be a finite time");
    Path& old = world.bodies[edited].path;
    Path joined;
    for (const Key<Pose>& key : old.keys)
        if (key.time_s < from_s) joined.keys.push_back(key);
    // Until then as before: two keys at one time are a jump.
    if (!joined.keys.empty()) joined.keys.push_back({from_s, old.at(from_s)});
    joined.keys.push_back({from_s, path.at(from_s)});
    for (const Key<Pose>& key : path.keys)
        if (key.time_s > from_s) joined.keys.push_back(key);
    old = std::move(joined);
    return edited;
}

Path with_keys(const Path& old, const std::vector<Key<Vec3>>& translation,
               const std::vector<Key<Quat>>& rotation) {
    const std::vector<Key<Pose>> rest =
        old.keys.empty() ? std::vector<Key<Pose>>{{0, Pose()}} : std::vector<Key<Pose>>(old.keys);
    std::vector<Moment> moments;
    add_moments(moments, translation);
    add_moments(moments, rotation);
    if (translation.empty() || rotation.empty()) add_moments(moments, rest);
    sort_moments(moments);
    Path path;
    for (const Moment& moment : moments) {
        Pose pose = value_in<Pose>(rest, moment.time_s, moment.side);
        if (!translation.empty()) pose.translation = value_in<Vec3>(translation, moment.time_s, moment.side);
        if (!rotation.empty()) pose.rotation = value_in<Quat>(rotation, moment.time_s, moment.side);
        path.keys.push_back({moment.time_s, pose});
    }
    return path;
}

Pose motion_of(const World& world, Index piece, const Shift& shift) {
    const Box box = bounds_of(world, piece);
    const Vec3 middle = 0.5F * (box.low + box.high);
    return {middle - shift.rotation * middle + shift.translation, shift.rotation};
}

Path shifted(const Path& path, const Shift& shift) {
    Path out = path;
    if (out.keys.empty()) out.keys.push_back({0, Pose()});
    for (Key<Pose>& key : out.keys) {
        key.value.translation += shift.translation;
        key.value.rotation = glm::normalize(shift.rotation * key.value.rotation);
    }
    return out;
}

}  // namespace afterglow
