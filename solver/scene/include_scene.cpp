#include "solver/scene/include_scene.h"

#include <algorithm>
#include <utility>

namespace afterglow {

namespace {

constexpr std::size_t max_nodes = 10'000'000;

/// Adds the tracks whose targets have a new number in `numbers`.
template <class T>
void add_renumbered(std::vector<Track<T>>& to, const std::vector<Track<T>>& from,
                    const std::vector<Index>& numbers) {
    for (const Track<T>& track : from)
        if (numbers[track.target] != no_index) to.push_back({numbers[track.target], track.keys});
}

}  // namespace

SceneIncluder::SceneIncluder(Scene& scene) : scene_(scene), own_materials_(scene.materials.size()) {
    for (Index m = 0; m < own_materials_; ++m) own_by_name_.emplace(scene.materials[m].name, m);
}

std::size_t SceneIncluder::add_file(Scene file) {
    const auto first_texture = static_cast<Index>(scene_.textures.size());
    const auto first_mesh = static_cast<Index>(scene_.meshes.size());
    std::move(file.textures.begin(), file.textures.end(), std::back_inserter(scene_.textures));
    std::vector<Index> materials;
    for (Material& material : file.materials) {
        const auto own = own_by_name_.find(material.name);
        if (own != own_by_name_.end()) {
            materials.push_back(own->second);
            continue;
        }
        materials.push_back(static_cast<Index>(scene_.materials.size()));
        if (material.texture != no_index) material.texture += first_texture;
        scene_.materials.push_back(std::move(material));
    }
    add_material_tracks(file.tracks, materials);
    for (Mesh& mesh : file.meshes) {
        for (Triangle& triangle : mesh.triangles) triangle.material = materials[triangle.material];
        scene_.meshes.push_back(std::move(mesh));
    }
    for (Node& node : file.nodes) {
        if (node.mesh != no_index) node.mesh += first_mesh;
        node.camera = no_index;
        node.light = no_index;
    }
    std::move(file.warnings.begin(), file.warnings.end(), std::back_inserter(scene_.warnings));
    files_.push_back({std::move(file.nodes), std::move(file.tracks)});
    return files_.size() - 1;
}

void SceneIncluder::add_material_tracks(const Tracks& tracks, const std::vector<Index>& materials) {
    // A material that the document defines anew takes no tracks from files.
    std::vector<Index> numbers = materials;
    for (Index& number : numbers)
        if (number < own_materials_) number = no_index;
    add_renumbered(scene_.tracks.material_emission, tracks.material_emission, numbers);
    add_renumbered(scene_.tracks.material_reflectance, tracks.material_reflectance, numbers);
}

void SceneIncluder::place(std::size_t file, Index parent, const std::string& prefix, const JsonView* only,
                          const JsonView& where) {
    const auto& [nodes, tracks] = files_[file];
    const Index top = only != nullptr ? Names(nodes, "node of this file").find(*only) : no_index;
    std::vector<Index> numbers(nodes.size(), no_index);
    bool shows_something = false;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const bool is_root = top == no_index ? nodes[n].parent == no_index : n == top;
        const Index above = nodes[n].parent == no_index ? no_index : numbers[nodes[n].parent];
        if (!is_root && above == no_index) continue;
        Node node = nodes[n];
        node.parent = is_root ? parent : above;
        node.name.insert(0, prefix + "/");
        numbers[n] = static_cast<Index>(scene_.nodes.size());
        shows_something |= node.mesh != no_index && !scene_.meshes[node.mesh].triangles.empty();
        scene_.nodes.push_back(std::move(node));
    }
    if (scene_.nodes.size() > max_nodes)
        throw Error(ErrorKind::too_large, where.place(), "with this file the scene has too many nodes");
    if (!shows_something) where.fail("there are no triangles in it");
    add_renumbered(scene_.tracks.node_translation, tracks.node_translation, numbers);
    add_renumbered(scene_.tracks.node_rotation, tracks.node_rotation, numbers);
}

}  // namespace afterglow
