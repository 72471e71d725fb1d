// Any bytes at all must give a scene whose indices are in range, or an Error; never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "solver/scene/gltf_reader.h"

namespace {

using afterglow::Index;
using afterglow::no_index;

void require(bool holds) {
    if (!holds) std::abort();
}

void check_meshes(const afterglow::Scene& scene) {
    for (const auto& mesh : scene.meshes) {
        require(mesh.texture_coordinates.empty() || mesh.texture_coordinates.size() == mesh.positions.size());
        for (const auto& position : mesh.positions) require(afterglow::is_finite(position));
        for (const auto& triangle : mesh.triangles) {
            require(triangle.material < scene.materials.size());
            for (const Index vertex : triangle.vertices) require(vertex < mesh.positions.size());
        }
    }
}

void check_nodes(const afterglow::Scene& scene) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const auto& node = scene.nodes[i];
        require(node.parent == no_index || node.parent < i);
        require(node.mesh == no_index || node.mesh < scene.meshes.size());
        require(node.camera == no_index || node.camera < scene.cameras.size());
        require(node.light == no_index || node.light < scene.lights.size());
    }
}

template <class T>
void check_tracks(const std::vector<afterglow::Track<T>>& tracks, std::size_t targets) {
    for (const auto& track : tracks) {
        require(track.target < targets && !track.keys.empty());
        for (std::size_t i = 1; i < track.keys.size(); ++i)
            require(track.keys[i - 1].time_s <= track.keys[i].time_s);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const auto format =
        bytes.starts_with("glTF") ? afterglow::SceneFormat::glb : afterglow::SceneFormat::gltf;
    try {
        const afterglow::Scene scene = afterglow::read_gltf(bytes, format, "fuzz", {}, {});
        check_meshes(scene);
        check_nodes(scene);
        check_tracks(scene.tracks.node_translation, scene.nodes.size());
        check_tracks(scene.tracks.node_rotation, scene.nodes.size());
        for (const auto& material : scene.materials)
            require(material.texture == no_index || material.texture < scene.textures.size());
    } catch (const afterglow::Error&) {
        // The one way out that is allowed.
    }
    return 0;
}
