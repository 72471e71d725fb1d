#include "solver/scene/load.h"

#include <algorithm>
#include <cctype>

#include "solver/base/file.h"
#include "solver/scene/bundle.h"
#include "solver/scene/gltf_reader.h"
#include "solver/scene/json_reader.h"
#include "solver/scene/obj_reader.h"
#include "solver/scene/resources.h"
#include "solver/scene/simplify.h"

namespace afterglow {

namespace {

Scene read_any(std::string_view bytes, SceneFormat format, const std::string& name,
               const ResourceReader& read_resource, const LoadConfig& config) {
    switch (format) {
        case SceneFormat::glb:
        case SceneFormat::gltf:
            return read_gltf(bytes, format, name, read_resource, config);
        case SceneFormat::obj:
            return read_obj(bytes, name, read_resource, config);
        case SceneFormat::json:
            return read_json_scene(bytes, name, read_resource, config);
        case SceneFormat::bundle:
            break;
    }
    throw Error(ErrorKind::unsupported, name, "this format is not read");
}

/// What every scene goes through once it is read. Errors name the file before the element.
Scene finished(Scene scene, const std::string& name, const LoadConfig& config) {
    if (config.background) scene.background = *config.background;
    try {
        validate(scene);
    } catch (const Error& e) {
        throw Error(e.kind(), name + ", " + e.place(), e.message());
    }
    simplify_tracks(scene.tracks, config);
    return scene;
}

}  // namespace

SceneFormat format_of(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".glb") return SceneFormat::glb;
    if (ending == ".gltf") return SceneFormat::gltf;
    if (ending == ".obj") return SceneFormat::obj;
    if (ending == ".json") return SceneFormat::json;
    throw Error(ErrorKind::unsupported, path.string(),
                "not a scene: names that end in .glb, .gltf, .obj or .json are read");
}

Scene load_scene(const std::filesystem::path& path, const LoadConfig& config) {
    const SceneFormat format = format_of(path);
    const std::string bytes = read_file(path);
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    return finished(read_any(bytes, format, path.string(), resources_in(folder), config), path.string(),
                    config);
}

Scene read_scene(std::string_view bytes, SceneFormat format, const std::string& name,
                 const LoadConfig& config) {
    if (format != SceneFormat::bundle)
        return finished(read_any(bytes, format, name, {}, config), name, config);
    const Bundle bundle = unpack(bytes, name);
    return finished(read_any(bundle.files.at(bundle.main), format_of(bundle.main), bundle.main,
                             resources_of(bundle), config),
                    bundle.main, config);
}

}  // namespace afterglow
