#include "service/jobs/edit.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "service/base/overloaded.h"
#include "solver/scene/default_camera.h"
#include "solver/scene/furniture.h"
#include "solver/scene/named.h"

namespace afterglow {

namespace {

/// What a material emits in the scene as uploaded. `field`: where its factor was asked for, for errors.
Rgb emission_in(const World& uploaded, const std::string& material, const char* field) {
    const Rgb emitted = uploaded.materials[index_named(uploaded.materials, 0, material, "material")].emission;
    if (max_channel(emitted) <= 0)
        throw Error(ErrorKind::invalid_input, field,
                    "this material emits nothing in the scene; give its emission");
    return emitted;
}

/// How strongly the lamps of a name shine there, likewise.
Rgb intensity_in(const World& uploaded, const std::string& lamp, const char* field) {
    const std::vector<Index> lamps = lamps_named(uploaded, lamp);
    const Rgb intensity = uploaded.lights[lamps.front()].light.intensity;
    for (const Index other : lamps)
        if (uploaded.lights[other].light.intensity != intensity)
            throw Error(ErrorKind::invalid_input, field,
                        "lamps of this name are of several strengths in the scene; give their intensity");
    if (max_channel(intensity) <= 0)
        throw Error(ErrorKind::invalid_input, field, "this lamp is off in the scene; give its intensity");
    return intensity;
}

/// Which of the two has a name; of materials those count that shine.
LightEdit::Of find_light(const World& uploaded, const std::string& name) {
    bool is_material = false, is_lamp = false;
    std::set<std::string> listed;
    std::string names;
    const auto note = [&](const std::string& other) {
        if (listed.insert(other).second) names += (names.empty() ? "; there are: " : ", ") + other;
        return other == name;
    };
    for (const Material& material : uploaded.materials)
        if (max_channel(material.emission) > 0 && note(material.name)) is_material = true;
    for (const PlacedLight& placed : uploaded.lights)
        if (note(placed.light.name)) is_lamp = true;
    if (is_material && is_lamp)
        throw Error(ErrorKind::invalid_input, "name",
                    "a material that shines and a lamp are both called \"" + name +
                        "\"; give material with its emission or emission_scale, or lamp with its intensity "
                        "or intensity_scale");
    if (is_material || is_lamp) return is_lamp ? LightEdit::Of::lamp : LightEdit::Of::material;
    throw Error(ErrorKind::not_found, "name", "nothing called \"" + name + "\" shines in the scene" + names);
}

}  // namespace

void resolve(Edit& edit, const World& uploaded) {
    auto* light = std::get_if<LightEdit>(&edit.what);
    if (light == nullptr || light->light) return;
    Json& source = edit.source["light"];
    const bool is_by_name = light->of == LightEdit::Of::either;
    if (is_by_name) light->of = find_light(uploaded, light->name);
    const bool is_lamp = light->of == LightEdit::Of::lamp;
    const char* const scale = is_lamp ? "intensity_scale" : "emission_scale";
    const char* const field = is_by_name ? "scale" : scale;
    const Rgb in_scene =
        is_lamp ? intensity_in(uploaded, light->name, field) : emission_in(uploaded, light->name, field);
    // What is kept says which it is.
    if (is_by_name)
        source = {{is_lamp ? "lamp" : "material", light->name}, {scale, light->scale.value_or(1)}};
    light->light = in_scene * static_cast<float>(light->scale.value_or(1));
    source[is_lamp ? "intensity" : "emission"] = {light->light->r, light->light->g, light->light->b};
}

ObjectKind kind_of(const World& world, const std::string& node) {
    const auto is_named = [&](const auto& element) { return element.name == node; };
    if (std::any_of(world.pieces.begin(), world.pieces.end(), is_named)) return ObjectKind::piece;
    if (std::any_of(world.bodies.begin() + 1, world.bodies.end(), is_named)) return ObjectKind::actor;
    std::string names;
    for (const FurniturePiece& piece : world.pieces) names += (names.empty() ? "" : ", ") + piece.name;
    for (Index k = furniture + 1; k < world.bodies.size(); ++k)
        names += (names.empty() ? "" : ", ") + world.bodies[k].name;
    throw Error(ErrorKind::not_found, "node", "there is no object \"" + node + "\"; there are: " + names);
}

Path path_of(const World& world, const PathEdit& edit) {
    const Index actor = index_named(world.bodies, furniture + 1, edit.node, "actor");
    return with_keys(world.bodies[actor].path, edit.translation, edit.rotation);
}

Path path_of(const World& world, const MoveEdit& edit) {
    const Index actor = index_named(world.bodies, furniture + 1, edit.node, "actor");
    return shifted(world.bodies[actor].path, edit.shift);
}

Body object_of(const World& world, const AddEdit& edit) {
    Body object = edit.object;
    const Index material = index_named(world.materials, 0, edit.material, "material");
    for (Triangle& triangle : object.triangles) triangle.material = material;
    return object;
}

PlacedCamera camera_of(const World& world, const std::string& camera, const CameraEdit& edit) {
    const std::string name = edit.camera.value_or(camera);
    std::vector<Camera> cameras;
    for (const PlacedCamera& placed : world.cameras) cameras.push_back(placed.camera);
    PlacedCamera chosen = world.cameras[name.empty() ? 0 : index_named(cameras, 0, name, "camera")];
    if (edit.view)
        chosen.path.keys = {{0, {edit.view->position, looking_at(edit.view->position, edit.view->look_at)}}};
    return chosen;
}

void apply(World& world, const Edit& edit) {
    const auto change = Overloaded{
        [&](const MoveEdit& move) {
            if (kind_of(world, move.node) == ObjectKind::actor) {
                set_path(world, move.node, 0, path_of(world, move));
                return;
            }
            const Index piece = index_named(world.pieces, 0, move.node, "piece");
            move_piece(world, piece, motion_of(world, piece, move.shift));
        },
        [&](const LightEdit& edited) {
            const auto set = edited.of == LightEdit::Of::lamp ? set_intensity : set_emission;
            set(world, edited.name, edited.light.value_or(Rgb(0)));
        },
        [&](const MaterialEdit& material) {
            set_reflectance(world, material.material, material.reflectance);
        },
        [](const CameraEdit&) {},
        [&](const PathEdit& path) { set_path(world, path.node, path.from_s, path_of(world, path)); },
        [&](const RemoveEdit& removed) {
            remove_piece(world, index_named(world.pieces, 0, removed.node, "piece"));
        },
        [&](const AddEdit& added) { add_piece(world, object_of(world, added)); },
    };
    std::visit(change, edit.what);
}

int first_frame_changed(const Edit& edit, int first, double frames_per_second) {
    const auto* path = std::get_if<PathEdit>(&edit.what);
    if (path == nullptr || path->from_s <= 0) return first;
    // A frame that shows the very time shows the new path.
    const double frame = std::ceil(path->from_s * frames_per_second - 1e-6);
    return std::max(first, static_cast<int>(std::min(frame, 1e9)));
}

}  // namespace afterglow
