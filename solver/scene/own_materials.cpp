#include "solver/scene/own_materials.h"

#include <algorithm>

namespace afterglow {

namespace {

/// Repeats the track of one target, if it has one, for another.
template <class T>
void repeat_track(std::vector<Track<T>>& tracks, Index from, Index to) {
    const auto track =
        std::find_if(tracks.begin(), tracks.end(), [&](const auto& t) { return t.target == from; });
    if (track == tracks.end()) return;
    Track<T> copy = *track;
    copy.target = to;
    tracks.push_back(std::move(copy));
}

}  // namespace

OwnMaterials::OwnMaterials(Scene& scene)
    : scene_(scene), nodes_of_mesh_(scene.meshes.size()), meshes_of_material_(scene.materials.size()) {
    for (const Node& node : scene.nodes)
        if (node.mesh != no_index) ++nodes_of_mesh_[node.mesh];
    for (Index mesh = 0; mesh < scene.meshes.size(); ++mesh)
        if (nodes_of_mesh_[mesh] > 0)
            for (const Index material : used_by(mesh)) ++meshes_of_material_[material];
}

std::vector<Index> OwnMaterials::used_by(Index mesh) const {
    std::vector<Index> out;
    for (const Triangle& triangle : scene_.meshes[mesh].triangles)
        if (out.empty() || out.back() != triangle.material) out.push_back(triangle.material);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

Index OwnMaterials::copy_of(Index material, Index node) {
    const auto copy = static_cast<Index>(scene_.materials.size());
    scene_.materials.push_back(scene_.materials[material]);
    scene_.materials.back().name += " of " + scene_.nodes[node].name;
    repeat_track(scene_.tracks.material_emission, material, copy);
    repeat_track(scene_.tracks.material_reflectance, material, copy);
    --meshes_of_material_[material];
    meshes_of_material_.push_back(1);
    return copy;
}

std::vector<Index> OwnMaterials::of(Index node) {
    const Index mesh = scene_.nodes[node].mesh;
    if (mesh == no_index) return {};
    std::vector<Index> materials = used_by(mesh);
    const bool shared_mesh = nodes_of_mesh_[mesh] > 1;
    const auto is_shared = [&](Index material) { return shared_mesh || meshes_of_material_[material] > 1; };
    if (std::none_of(materials.begin(), materials.end(), is_shared)) return materials;

    // The mesh is copied even where only this node shows it: what was there stays as it was, so that an
    // error later on can take everything back.
    Mesh copy = scene_.meshes[mesh];
    if (shared_mesh)
        for (const Index material : materials) ++meshes_of_material_[material];
    const std::vector<Index> originals = materials;
    for (Index& material : materials)
        if (is_shared(material)) material = copy_of(material, node);
    for (Triangle& triangle : copy.triangles) {
        const auto original = std::lower_bound(originals.begin(), originals.end(), triangle.material);
        triangle.material = materials[static_cast<std::size_t>(original - originals.begin())];
    }
    --nodes_of_mesh_[mesh];
    nodes_of_mesh_.push_back(1);
    scene_.nodes[node].mesh = static_cast<Index>(scene_.meshes.size());
    scene_.meshes.push_back(std::move(copy));
    return materials;
}

}  // namespace afterglow
