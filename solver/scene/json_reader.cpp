#include "solver/scene/json_reader.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "solver/base/other_pictures.h"
#include "solver/base/pixels.h"
#include "solver/scene/default_camera.h"
#include "solver/scene/gltf_reader.h"
#include "solver/scene/include_scene.h"
#include "solver/scene/json_geometry.h"
#include "solver/scene/json_rows.h"
#include "solver/scene/names.h"
#include "solver/scene/obj_reader.h"
#include "solver/scene/paths.h"
#include "solver/scene/reflectance.h"

namespace afterglow {

namespace {

constexpr std::uint64_t max_texels = std::uint64_t{128} << 20U;

double metres_per_unit(const JsonView& document) {
    const auto unit = document.find("units");
    if (!unit) return 1;
    const std::map<std::string, double> lengths{
        {"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};
    const auto length = lengths.find(unit->as_string());
    if (length == lengths.end())
        unit->fail("expected \"m\", \"cm\", \"mm\", \"in\" or \"ft\", found " + in_quotes(unit->as_string()));
    return length->second;
}

/// The folder part of a reference, with its slash.
std::string folder_of(const std::string& uri) {
    const auto slash = uri.rfind('/');
    return slash == std::string::npos ? "" : uri.substr(0, slash + 1);
}

class JsonReader {
  public:
    JsonReader(JsonView document, const ResourceReader& read_resource, const LoadConfig& config)

        : document_(std::move(document)), read_resource_(read_resource), config_(config) {}

    Scene read(const std::string& name) {
        document_.allow_only({"afterglow", "name", "units", "frames_per_second", "duration_s", "background",
                              "materials", "nodes", "cameras", "lights", "time_unit", "tracks"});
        static_cast<void>(document_.at("afterglow").as_integer_in(1, 1));
        const auto title = document_.find("name");
        scene_.name = title ? title->as_string() : name;
        unit_ = metres_per_unit(document_);
        if (const auto rate = document_.find("frames_per_second")) {
            scene_.frames_per_second = rate->as_number_in(0, 1000);
            if (!(scene_.frames_per_second > 0)) rate->fail("must be above 0");
        }
        if (const auto duration = document_.find("duration_s"))
            scene_.duration_s = duration->as_number_in(0, 1e9);
        if (const auto background = document_.find("background")) scene_.background = as_rgb(*background);
        each("materials", &JsonReader::read_material);
        materials_.emplace(scene_.materials, "material");
        includer_.emplace(scene_);
        each("nodes", &JsonReader::read_node);
        each("cameras", &JsonReader::read_camera);
        each("lights", &JsonReader::read_light);
        if (const auto tracks = document_.find("tracks"))
            add_tracks(scene_, *tracks, seconds_per_unit(document_, scene_.frames_per_second), unit_);
        return std::move(scene_);
    }

  private:
    void each(std::string_view list, void (JsonReader::*read_one)(const JsonView&)) {
        if (const auto view = document_.find(list))
            for (const auto& element : view->elements()) (this->*read_one)(element);
    }

    [[nodiscard]] Vec3 length3(const JsonView& view) const {
        const auto numbers = view.as_numbers(3);
        return {to_single(view, numbers[0] * unit_), to_single(view, numbers[1] * unit_),
                to_single(view, numbers[2] * unit_)};
    }

    void read_material(const JsonView& view) {
        view.allow_only({"name", "reflectance", "texture", "emission", "shines"});
        Material material;
        material.name = view.at("name").as_string();
        if (!material_names_.insert(material.name).second)
            view.at("name").fail("is given to an earlier material already");
        if (const auto reflectance = view.find("reflectance")) material.reflectance = as_rgb(*reflectance);
        if (const auto emission = view.find("emission")) material.emission = as_rgb(*emission);
        if (const auto texture = view.find("texture")) {
            material.texture = read_texture(*texture);
            if (!view.find("reflectance")) material.reflectance = Rgb(largest_reflectance);
        }
        if (const auto shines = view.find("shines")) {
            const std::string side = shines->as_string();
            if (side == "both")
                material.shines = Material::Shines::both;
            else if (side != "front")
                shines->fail("expected \"front\" or \"both\", found " + in_quotes(side));
        }
        scene_.materials.push_back(std::move(material));
    }

    /// The bytes of a file that the document names.
    std::string fetch(const JsonView& reference) {
        const std::string uri = reference.as_string();
        if (!read_resource_)
            reference.fail("refers to the file " + in_quotes(uri) +
                           "; a scene sent by itself must contain everything");
        try {
            return read_resource_(uri);
        } catch (const Error& e) {
            throw Error(e.kind(), reference.place(), e.what());
        }
    }

    Index read_texture(const JsonView& reference) {
        const auto [known, is_new] =
            textures_.try_emplace(reference.as_string(), static_cast<Index>(scene_.textures.size()));
        if (!is_new) return known->second;
        Bytes8 pixels = decode_texture(fetch(reference), reference.place());
        texels_ += pixels.rgba.size() / 4;
        if (texels_ > max_texels)
            throw Error(ErrorKind::too_large, reference.place(),
                        "the textures have more than 128 Mi pixels in all");
        scene_.textures.push_back({known->first, pixels.width, pixels.height, std::move(pixels.rgba)});
        return known->second;
    }

    void read_node(const JsonView& view) {
        view.allow_only({"name", "parent", "translation", "rotation", "scale", "geometry"});
        Node node;
        node.name = view.at("name").as_string();
        if (const auto parent = view.find("parent")) node.parent = parents_[find_parent(*parent)];
        if (const auto translation = view.find("translation")) node.local.translation = length3(*translation);
        if (const auto rotation = view.find("rotation")) node.local.rotation = as_rotation(*rotation);
        if (const auto scale = view.find("scale"))
            node.local.scale =
                scale->value().is_number() ? Vec3(to_single(*scale, scale->as_number())) : scale->as_vec3();
        const auto index = static_cast<Index>(scene_.nodes.size());
        parents_.push_back(index);
        parent_names_.add(node.name);
        const auto geometry = view.find("geometry");
        const bool is_inline = geometry && is_inline_geometry(*geometry);
        if (is_inline) {
            node.mesh = static_cast<Index>(scene_.meshes.size());
            scene_.meshes.push_back(inline_mesh(*geometry, *materials_, unit_));
            scene_.meshes.back().name = node.name;
        }
        const std::string name = node.name;
        scene_.nodes.push_back(std::move(node));
        if (geometry && !is_inline) include(*geometry, index, name);
    }

    Index find_parent(const JsonView& view) const {
        if (!parent_names_.contains(view.as_string()))
            view.fail("no node before this one is named " + in_quotes(view.as_string()) +
                      "; parents stand before their children");
        return parent_names_.find(view);
    }

    void include(const JsonView& geometry, Index parent, const std::string& prefix) {
        if (!geometry.find("file")) geometry.fail("needs \"positions\", \"box\", \"quad\" or \"file\"");
        geometry.allow_only({"file", "node"});
        const JsonView file = geometry.at("file");
        const std::string uri = file.as_string();
        auto known = files_.find(uri);
        if (known == files_.end())
            known = files_.emplace(uri, includer_->add_file(read_file_scene(file))).first;
        const auto only = geometry.find("node");
        includer_->place(known->second, parent, prefix, only ? &*only : nullptr, geometry);
    }

    Scene read_file_scene(const JsonView& reference) {
        const std::string uri = reference.as_string();
        const std::string folder = folder_of(uri);
        const auto read_beside = [&](const std::string& other) { return read_resource_(folder + other); };
        const std::string bytes = fetch(reference);
        try {
            const SceneFormat format = format_of(uri);
            if (format == SceneFormat::obj) return read_obj(bytes, uri, read_beside, config_);
            if (format == SceneFormat::json) reference.fail("only .glb, .gltf and .obj files can be placed");
            return read_gltf(bytes, format, uri, read_beside, config_);
        } catch (const Error& e) {
            if (e.place() == reference.place()) throw;
            throw Error(e.kind(), reference.place(), e.what());
        }
    }

    /// Adds a node for a camera or a light that stands somewhere and looks somewhere.
    Node& add_view(const JsonView& view, std::string_view target, bool needs_target) {
        Node node;
        node.name = view.at("name").as_string();
        if (const auto position = view.find("position")) node.local.translation = length3(*position);
        const auto aim = view.find(target);
        if (!aim && needs_target) static_cast<void>(view.at(target));
        if (aim) {
            const Vec3 to = target == "direction" ? node.local.translation + aim->as_vec3() : length3(*aim);
            const auto up = view.find("up");
            const Vec3 offset = to - node.local.translation;
            if (!(glm::length(offset) > 0)) aim->fail("has no direction");
            node.local.rotation = looking_at(node.local.translation, to, up ? up->as_vec3() : Vec3(0, 1, 0));
        }
        scene_.nodes.push_back(std::move(node));
        return scene_.nodes.back();
    }

    void read_camera(const JsonView& view) {
        view.allow_only({"name", "position", "look_at", "up", "vertical_angle_deg"});
        static_cast<void>(view.at("position"));
        Camera camera{view.at("name").as_string(), 0.7F};
        if (const auto angle = view.find("vertical_angle_deg"))
            camera.vertical_angle = glm::radians(to_single(*angle, angle->as_number_in(0.1, 179)));
        add_view(view, "look_at", true).camera = static_cast<Index>(scene_.cameras.size());
        scene_.cameras.push_back(camera);
    }

    void read_light(const JsonView& view) {
        Light light;
        light.name = view.at("name").as_string();
        light.intensity = as_rgb(view.at("intensity"));
        const std::string kind = view.at("kind").as_string();
        if (kind == "point") {
            view.allow_only({"name", "kind", "intensity", "position"});
        } else if (kind == "directional") {
            light.kind = Light::Kind::directional;
            view.allow_only({"name", "kind", "intensity", "direction"});
        } else if (kind == "spot") {
            light.kind = Light::Kind::spot;
            view.allow_only(
                {"name", "kind", "intensity", "position", "look_at", "inner_angle_deg", "outer_angle_deg"});
            light.outer_cone_angle =
                glm::radians(to_single(view, view.at("outer_angle_deg").as_number_in(0, 90)));
            if (const auto inner = view.find("inner_angle_deg"))
                light.inner_cone_angle = glm::radians(to_single(*inner, inner->as_number_in(0, 90)));
        } else {
            view.at("kind").fail("expected \"point\", \"spot\" or \"directional\", found " + in_quotes(kind));
        }
        if (kind != "directional") static_cast<void>(view.at("position"));
        add_view(view, kind == "directional" ? "direction" : "look_at", kind != "point").light =
            static_cast<Index>(scene_.lights.size());
        scene_.lights.push_back(std::move(light));
    }

    JsonView document_;
    const ResourceReader& read_resource_;
    const LoadConfig& config_;
    Scene scene_;
    double unit_ = 1;
    std::set<std::string> material_names_;
    std::optional<Names> materials_;
    std::optional<SceneIncluder> includer_;
    std::vector<Index> parents_;  ///< the scene's number of each node that the document itself defines
    Names parent_names_{std::vector<Node>{}, "node"};
    std::map<std::string, Index> textures_;
    std::map<std::string, std::size_t> files_;
    std::uint64_t texels_ = 0;
};

}  // namespace

Scene read_json_scene(std::string_view text, const std::string& name, const ResourceReader& read_resource,
                      const LoadConfig& config) {
    const Json json = parse_json(text, name);
    return JsonReader(JsonView(json, name), read_resource, config).read(name);
}

}  // namespace afterglow
