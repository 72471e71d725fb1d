#include "solver/scene/gltf_reader.h"

#include "solver/scene/gltf_animation.h"
#include "solver/scene/gltf_document.h"
#include "solver/scene/gltf_lights.h"
#include "solver/scene/gltf_materials.h"
#include "solver/scene/gltf_meshes.h"
#include "solver/scene/gltf_nodes.h"

namespace afterglow {

Scene read_gltf(std::string_view bytes, SceneFormat format, const std::string& name,
                const ResourceReader& read_resource, const LoadConfig& config) {
    const auto document = gltf::open_document(bytes, format, name, read_resource);
    Scene scene;
    scene.name = name;
    const auto surfaces = gltf::read_materials(*document, scene);
    gltf::read_meshes(*document, surfaces, scene);
    const auto cameras = gltf::read_cameras(*document, scene);
    gltf::read_lights(*document, config.lumen_scale, scene);
    const auto places = gltf::read_nodes(*document, cameras, scene);
    gltf::read_animations(*document, places, scene);
    return scene;
}

}  // namespace afterglow
