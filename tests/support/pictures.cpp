#include "tests/support/pictures.h"

#include <algorithm>
#include <sstream>

#include "solver/scene/load.h"

namespace afterglow::testing {

std::vector<Picture> pictures_of(World world, const SequenceConfig& config, int frame) {
    std::vector<Picture> out;
    render_sequence(
        std::move(world), config, frame, frame, [&](const Revision& r) { out.push_back(r.radiance); },
        Context(1));
    return out;
}

std::string faults_of(const Picture& picture) {
    std::size_t count = 0;
    std::ostringstream out;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const Rgb& p = picture.at(x, y);
            if (is_finite(p) && std::min({p.r, p.g, p.b}) >= 0) continue;
            if (count++ == 0)
                out << "pixel (" << x << ", " << y << ") is " << p.r << ' ' << p.g << ' ' << p.b;
        }
    }
    if (count > 1) out << ", and " << count - 1 << " more";
    return out.str();
}

float brightest(const Picture& picture) {
    float out = 0;
    for (const Rgb& pixel : picture.pixels) out = std::max(out, max_channel(pixel));
    return out;
}

namespace {

Index add_node(Scene& scene, const std::string& name, const Path& path) {
    const auto index = static_cast<Index>(scene.nodes.size());
    Node& node = scene.nodes.emplace_back();
    node.name = name;
    if (path.keys.empty()) return index;
    node.local.translation = path.keys.front().value.translation;
    node.local.rotation = path.keys.front().value.rotation;
    if (!path.moves()) return index;
    Track<Vec3> translation{index, {}};
    Track<Quat> rotation{index, {}};
    for (const auto& key : path.keys) {
        translation.keys.push_back({key.time_s, key.value.translation});
        rotation.keys.push_back({key.time_s, key.value.rotation});
    }
    scene.tracks.node_translation.push_back(translation);
    scene.tracks.node_rotation.push_back(rotation);
    return index;
}

}  // namespace

Scene scene_of(const World& world) {
    Scene scene;
    scene.name = world.name;
    scene.materials = world.materials;
    scene.textures = world.textures;
    scene.background = world.background;
    scene.frames_per_second = world.frames_per_second;
    for (const Body& body : world.bodies) {
        scene.nodes[add_node(scene, body.name, body.path)].mesh = static_cast<Index>(scene.meshes.size());
        scene.meshes.push_back({body.name, body.positions, body.texture_coordinates, body.triangles});
    }
    for (const PlacedCamera& camera : world.cameras) {
        scene.nodes[add_node(scene, camera.camera.name, camera.path)].camera =
            static_cast<Index>(scene.cameras.size());
        scene.cameras.push_back(camera.camera);
    }
    for (const PlacedLight& light : world.lights) {
        scene.nodes[add_node(scene, light.light.name, light.path)].light =
            static_cast<Index>(scene.lights.size());
        scene.lights.push_back(light.light);
    }
    return scene;
}

World from_file(const World& world) {
    Scene scene = scene_of(world);
    validate(scene);
    return assemble(scene);
}

}  // namespace afterglow::testing
