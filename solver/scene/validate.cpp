#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "solver/scene/area.h"
#include "solver/scene/check_tracks.h"
#include "solver/scene/default_camera.h"
#include "solver/scene/load.h"
#include "solver/scene/place.h"
#include "solver/scene/reflectance.h"
#include "solver/scene/world.h"

namespace afterglow {

namespace {

constexpr std::uint64_t max_triangles = 50'000'000;
constexpr std::uint64_t max_positions = 3 * max_triangles;
constexpr std::size_t max_elements = 10'000'000;  ///< of any other list
constexpr float max_coordinate_m = 1e7F;          ///< single precision resolves 1 m there
constexpr float max_radiance = 1e9F;              ///< W/m²/sr; the sun's disc has 2e7

[[noreturn]] void reject(const std::string& place, const std::string& message) {
    throw Error(ErrorKind::invalid_input, place, message);
}

/// Checks an index that may be absent.
void check_optional(Index index, std::size_t size, const std::string& place, const std::string& what) {
    if (index != no_index && index >= size)
        reject(place, what + " " + std::to_string(index) + " does not exist");
}

void check_light_value(const Rgb& value, const std::string& place, const std::string& what) {
    if (!is_finite(value) || std::min({value.r, value.g, value.b}) < 0)
        reject(place, what + " must be finite and not negative");
    if (max_channel(value) > max_radiance) reject(place, what + " is brighter than anything real (1e9)");
}

void check_textures(const Scene& scene) {
    for (std::size_t t = 0; t < scene.textures.size(); ++t) {
        const Texture& texture = scene.textures[t];
        if (texture.width <= 0 || texture.height <= 0 ||
            texture.rgba.size() != std::uint64_t{4} * static_cast<std::uint64_t>(texture.width) *
                                       static_cast<std::uint64_t>(texture.height))
            reject(place_of("texture", texture.name, t), "its size does not fit its pixels");
    }
}

void check_materials(const Scene& scene) {
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        const auto place = place_of("material", material.name, m);
        check_light_value(material.emission, place, "emission");
        check_light_value(material.reflectance, place, "reflectance");
        check_optional(material.texture, scene.textures.size(), place, "texture");
    }
}

void check_positions(const Mesh& mesh, const std::string& place) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3& p = mesh.positions[v];
        const auto vertex = [&] { return place + ", vertex " + std::to_string(v); };
        if (!is_finite(p)) reject(vertex(), "is not finite");
        if (max_channel(glm::abs(p)) > max_coordinate_m)
            reject(vertex(), "lies more than 10,000 km out; check the units");
    }
    if (!mesh.texture_coordinates.empty() && mesh.texture_coordinates.size() != mesh.positions.size())
        reject(place, "has texture coordinates for some positions only");
    for (std::size_t v = 0; v < mesh.texture_coordinates.size(); ++v)
        if (!is_finite(Vec3(mesh.texture_coordinates[v], 0)))
            reject(place + ", vertex " + std::to_string(v), "its texture coordinates are not finite");
}

/// Checks a mesh and drops the triangles without area.
void check_mesh(Mesh& mesh, std::size_t materials, const std::string& place, Warnings& warnings) {
    check_positions(mesh, place);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto triangle = [&] { return place + ", triangle " + std::to_string(t); };
        for (const Index vertex : mesh.triangles[t].vertices)
            if (vertex >= mesh.positions.size())
                reject(triangle(), "vertex " + std::to_string(vertex) + " does not exist");
        if (mesh.triangles[t].material >= materials)
            reject(triangle(), "material " + std::to_string(mesh.triangles[t].material) + " does not exist");
    }
    const auto is_flat = [&](const Triangle& triangle) {
        const auto& [a, b, c] = triangle.vertices;
        return !has_area(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
    };
    const auto kept = std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), is_flat);
    const auto dropped = std::distance(kept, mesh.triangles.end());
    mesh.triangles.erase(kept, mesh.triangles.end());
    if (dropped > 0)
        warnings.push_back({place, std::to_string(dropped) + (dropped == 1 ? " triangle" : " triangles") +
                                       " without area left out"});
}

void check_transform(const Transform& local, const std::string& place) {
    if (!is_finite(local.translation) || !is_finite(local.scale))
        reject(place, "its transform is not finite");
    if (!(std::abs(glm::length(local.rotation) - 1.0F) < 1e-3F))
        reject(place, "its rotation is not a quaternion of length 1");
}

void check_nodes(const Scene& scene) {
    std::uint64_t triangles = 0;
    std::uint64_t positions = 0;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        const auto place = place_of("node", node.name, n);
        check_optional(node.mesh, scene.meshes.size(), place, "mesh");
        check_optional(node.camera, scene.cameras.size(), place, "camera");
        check_optional(node.light, scene.lights.size(), place, "light");
        if (node.parent != no_index && node.parent >= n)
            reject(place, "its parent does not stand before it, so the hierarchy may be recursive");
        check_transform(node.local, place);
        if (node.mesh == no_index) continue;
        triangles += scene.meshes[node.mesh].triangles.size();
        positions += scene.meshes[node.mesh].positions.size();
        if (triangles > max_triangles || positions > max_positions)
            throw Error(ErrorKind::too_large, place,
                        "with this node the scene has more than 50 million triangles");
    }
    if (triangles == 0) reject("scene", "contains no triangles");
}

void check_cameras_and_lights(const Scene& scene) {
    for (std::size_t c = 0; c < scene.cameras.size(); ++c)
        if (!(scene.cameras[c].vertical_angle > 0) || !(scene.cameras[c].vertical_angle < pi))
            reject(place_of("camera", scene.cameras[c].name, c),
                   "its angle must lie between 0 and 180 degrees");
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        const Light& light = scene.lights[l];
        const auto place = place_of("light", light.name, l);
        check_light_value(light.intensity, place, "intensity");
        if (!(light.inner_cone_angle >= 0) || !(light.inner_cone_angle <= light.outer_cone_angle) ||
            !(light.outer_cone_angle <= pi / 2 + 1e-5F))
            reject(place, "its cone angles must satisfy 0 <= inner <= outer <= 90 degrees");
    }
    check_light_value(scene.background, "background", "radiance");
}

/// Which materials shine at some time.
std::vector<bool> shining_materials(const Scene& scene) {
    std::vector<bool> shines;
    for (const Material& material : scene.materials) shines.push_back(max_channel(material.emission) > 0);
    for (const auto& track : scene.tracks.material_emission)
        if (std::all_of(track.keys.begin(), track.keys.end(), [](const auto& key) { return key.value <= 0; }))
            shines[track.target] = false;
    return shines;
}

bool is_lit(const Scene& scene) {
    if (max_channel(scene.background) > 0) return true;
    const auto shines = shining_materials(scene);
    return std::any_of(scene.nodes.begin(), scene.nodes.end(), [&](const Node& node) {
        if (node.light != no_index && max_channel(scene.lights[node.light].intensity) > 0) return true;
        if (node.mesh == no_index) return false;
        const auto& triangles = scene.meshes[node.mesh].triangles;
        return std::any_of(triangles.begin(), triangles.end(),
                           [&](const Triangle& triangle) { return shines[triangle.material]; });
    });
}

void check_sizes(const Scene& scene) {
    const auto check = [](std::size_t size, const char* what) {
        if (size > max_elements)
            throw Error(ErrorKind::too_large, "scene", std::string("has more than 10 million ") + what);
    };
    check(scene.materials.size(), "materials");
    check(scene.textures.size(), "textures");
    check(scene.meshes.size(), "meshes");
    check(scene.nodes.size(), "nodes");
    check(scene.cameras.size(), "cameras");
    check(scene.lights.size(), "lights");
}

}  // namespace

void validate(Scene& scene) {
    check_sizes(scene);
    check_textures(scene);
    check_materials(scene);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        check_mesh(scene.meshes[m], scene.materials.size(), place_of("mesh", scene.meshes[m].name, m),
                   scene.warnings);
    check_nodes(scene);
    check_cameras_and_lights(scene);
    check_tracks(scene);
    scene.duration_s = std::max(scene.duration_s, last_key_time(scene.tracks));
    if (!is_lit(scene))
        reject("scene",
               "nothing in it shines. Blender's area lamps are not exported to glTF as surfaces: use an "
               "emissive "
               "material, a point light or a background");
    limit_reflectance(scene);
    const auto has_camera = [](const Node& node) { return node.camera != no_index; };
    if (std::none_of(scene.nodes.begin(), scene.nodes.end(), has_camera)) {
        add_default_camera(scene, assemble(scene));
        scene.warnings.push_back({"camera", "the scene has none, so one was placed that shows all of it"});
    }
}

}  // namespace afterglow
