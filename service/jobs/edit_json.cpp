#include "service/jobs/edit_json.h"

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "solver/scene/furniture.h"
#include "solver/scene/json_geometry.h"
#include "solver/scene/json_rows.h"
#include "solver/scene/names.h"
#include "solver/scene/track_keys.h"

namespace afterglow {

namespace {

constexpr double largest_m = 1e6;  // no place is farther away

/// A place or a way in metres.
Vec3 read_metres(const JsonView& field) {
    const Vec3 value = field.as_vec3();
    if (!is_finite(value) || max_channel(glm::abs(value)) > static_cast<float>(largest_m))
        field.fail("must lie within a million metres");
    return value;
}

Shift read_shift(const JsonView& view) {
    Shift shift;
    if (const auto field = view.find("translation")) shift.translation = read_metres(*field);
    if (const auto field = view.find("rotation")) shift.rotation = as_rotation(*field);
    return shift;
}

MoveEdit read_move(const JsonView& view) {
    view.allow_only({"node", "translation", "rotation"});
    MoveEdit edit{view.at("node").as_string(), read_shift(view)};
    if (!view.find("translation") && !view.find("rotation")) view.fail("needs a translation or a rotation");
    return edit;
}

LightEdit read_light(const JsonView& view) {
    constexpr double largest_scale = 1e6;
    LightEdit edit;
    if (const auto name = view.find("name")) {
        view.allow_only({"name", "scale"});
        edit.of = LightEdit::Of::either;
        edit.name = name->as_string();
        edit.scale = view.at("scale").as_number_in(0, largest_scale);
        return edit;
    }
    const bool is_lamp = view.find("lamp").has_value();
    const std::string of = is_lamp ? "lamp" : "material", light = is_lamp ? "intensity" : "emission";
    const std::string scale = light + "_scale";
    view.allow_only({of, light, scale});
    if (!view.find(of)) view.fail("needs a material, a lamp, or a name that one of them has");
    edit.of = is_lamp ? LightEdit::Of::lamp : LightEdit::Of::material;
    edit.name = view.at(of).as_string();
    if (const auto field = view.find(light)) edit.light = as_rgb(*field);
    if (const auto field = view.find(scale)) edit.scale = field->as_number_in(0, largest_scale);
    if (!edit.light && !edit.scale) view.fail("needs " + light + " or " + scale);
    return edit;
}

MaterialEdit read_material(const JsonView& view) {
    view.allow_only({"material", "reflectance"});
    const JsonView reflectance = view.at("reflectance");
    MaterialEdit edit{view.at("material").as_string(), as_rgb(reflectance)};
    if (max_channel(edit.reflectance) >= 1) reflectance.fail("must be below 1");
    return edit;
}

CameraEdit read_camera(const JsonView& view) {
    view.allow_only({"camera", "position", "look_at"});
    CameraEdit edit;
    if (const auto field = view.find("camera")) edit.camera = field->as_string();
    if (view.find("position") || view.find("look_at")) {
        const JsonView look_at = view.at("look_at");
        edit.view = {read_metres(view.at("position")), read_metres(look_at)};
        if (!(glm::length(edit.view->look_at - edit.view->position) > 1e-6F))
            look_at.fail("the camera stands in the point it looks at");
    }
    if (!edit.camera && !edit.view) view.fail("needs a camera, or position and look_at");
    return edit;
}

PathEdit read_path(const JsonView& view) {
    view.allow_only({"node", "from_s", "translation", "rotation"});
    PathEdit edit;
    edit.node = view.at("node").as_string();
    if (const auto field = view.find("from_s")) edit.from_s = field->as_number_in(0, 1e9);
    if (const auto field = view.find("translation")) edit.translation = position_keys(*field, {});
    if (const auto field = view.find("rotation")) edit.rotation = rotation_keys(*field, {});
    if (edit.translation.empty() && edit.rotation.empty())
        view.fail("needs keys of a translation or a rotation");
    return edit;
}

AddEdit read_add(const JsonView& view) {
    view.allow_only({"node", "translation", "rotation", "geometry"});
    const JsonView geometry = view.at("geometry");
    if (!is_inline_geometry(geometry)) geometry.fail("expected positions, box or quad");
    AddEdit edit;
    edit.material = geometry.at("material").as_string();
    struct Named {
        std::string name;
    };
    // Which number the material has is known only where the world is.
    const Mesh mesh = inline_mesh(geometry, Names(std::vector<Named>{{edit.material}}, "material"), 1);
    const Shift place = read_shift(view);
    edit.object.name = view.at("node").as_string();
    edit.object.texture_coordinates = mesh.texture_coordinates;
    edit.object.triangles = mesh.triangles;
    for (const Vec3& position : mesh.positions)
        edit.object.positions.push_back(place.rotation * position + place.translation);
    return edit;
}

}  // namespace

Edit read_edit(const JsonView& edit) {
    const auto members = edit.members();
    if (members.size() != 1) edit.fail("expected one of move, light, material, camera, path, remove, add");
    const auto& [kind, view] = members.front();
    Edit out{{}, edit.value()};
    if (kind == "move") {
        out.what = read_move(view);
    } else if (kind == "light") {
        out.what = read_light(view);
    } else if (kind == "material") {
        out.what = read_material(view);
    } else if (kind == "camera") {
        out.what = read_camera(view);
    } else if (kind == "path") {
        out.what = read_path(view);
    } else if (kind == "remove") {
        view.allow_only({"node"});
        out.what = RemoveEdit{view.at("node").as_string()};
    } else if (kind == "add") {
        out.what = read_add(view);
    } else {
        view.fail("there is no such edit; there are move, light, material, camera, path, remove, add");
    }
    return out;
}

std::vector<Edit> read_edits(const JsonView& request) {
    request.allow_only({"edits"});
    const JsonView list = request.at("edits");
    std::vector<Edit> edits;
    for (const JsonView& edit : list.elements()) {
        if (edits.size() == max_edits_of_a_request)
            throw Error(ErrorKind::too_large, edit.place(),
                        "more than " + std::to_string(max_edits_of_a_request) + " edits in one request");
        edits.push_back(read_edit(edit));
    }
    if (edits.empty()) list.fail("needs at least one edit");
    return edits;
}

Json sources_of(const std::vector<Edit>& edits) {
    Json sources = Json::array();
    for (const Edit& edit : edits) sources.push_back(edit.source);
    return sources;
}

std::vector<Edit> edits_of_sources(const Json& sources) {
    std::vector<Edit> edits;
    for (const JsonView& edit : JsonView(sources, "edit record").elements()) edits.push_back(read_edit(edit));
    return edits;
}

Json to_json(const JobEdit& edit, int revision) {
    return {{"revision", revision},
            {"first_frame", edit.first_frame},
            {"reused", edit.reused ? Json(*edit.reused) : Json(nullptr)},
            {"edits", sources_of(edit.edits)}};
}

namespace {

Json json_of(const Vec3& v) {
    return Json::array({v.x, v.y, v.z});
}

Json object_json(const std::string& name, const char* kind, const Box& box) {
    return {{"node", name}, {"kind", kind}, {"low", json_of(box.low)}, {"high", json_of(box.high)}};
}

Json material_json(const Material& material, const Material& uploaded) {
    const float emitted = max_channel(uploaded.emission);
    return {{"material", material.name},
            {"reflectance", json_of(material.reflectance)},
            {"emission", json_of(material.emission)},
            {"emission_scale", emitted > 0 ? Json(max_channel(material.emission) / emitted) : Json(nullptr)}};
}

const char* name_of(Light::Kind kind) {
    switch (kind) {
        case Light::Kind::point:
            return "point";
        case Light::Kind::spot:
            return "spot";
        case Light::Kind::directional:
            return "directional";
    }
    return "";
}

/// One entry a name: those that share it are edited together.
Json lamps_json(const World& world, const World& uploaded) {
    struct Named {
        Index first = no_index;
        bool is_of_one_strength = true;  ///< in the scene as uploaded
    };
    std::map<std::string, Named> lamps;
    for (Index l = 0; l < uploaded.lights.size(); ++l) {
        const Light& light = uploaded.lights[l].light;
        Named& named = lamps[light.name];
        if (named.first == no_index) named.first = l;
        if (light.intensity != uploaded.lights[named.first].light.intensity) named.is_of_one_strength = false;
    }
    Json list = Json::array();
    for (Index l = 0; l < world.lights.size(); ++l) {
        const Light& light = world.lights[l].light;
        const Named& named = lamps.at(light.name);
        if (named.first != l) continue;
        const float in_scene =
            named.is_of_one_strength ? max_channel(uploaded.lights[l].light.intensity) : 0.0F;
        list.push_back({{"lamp", light.name},
                        {"kind", name_of(light.kind)},
                        {"intensity", json_of(light.intensity)},
                        {"intensity_scale",
                         in_scene > 0 ? Json(max_channel(light.intensity) / in_scene) : Json(nullptr)}});
    }
    return list;
}

}  // namespace

Json editable_json(const World& world, const World& uploaded) {
    Json objects = Json::array(), materials = Json::array(), cameras = Json::array();
    for (Index piece = 0; piece < world.pieces.size(); ++piece)
        objects.push_back(object_json(world.pieces[piece].name, "furniture", bounds_of(world, piece)));
    for (Index k = furniture + 1; k < world.bodies.size(); ++k) {
        const Pose pose = world.bodies[k].path.at(0);
        Box box;
        for (const Vec3& position : world.bodies[k].positions) box.add(pose.point(position));
        objects.push_back(object_json(world.bodies[k].name, "actor", box));
    }
    for (std::size_t k = 0; k < world.materials.size(); ++k)
        materials.push_back(material_json(world.materials[k], uploaded.materials[k]));
    for (const PlacedCamera& placed : world.cameras) cameras.push_back(placed.camera.name);
    return {{"objects", std::move(objects)},
            {"materials", std::move(materials)},
            {"lamps", lamps_json(world, uploaded)},
            {"cameras", std::move(cameras)}};
}

}  // namespace afterglow
