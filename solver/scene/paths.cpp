#include "solver/scene/paths.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "solver/scene/camera_track.h"
#include "solver/scene/load.h"
#include "solver/scene/names.h"
#include "solver/scene/own_materials.h"
#include "solver/scene/resources.h"
#include "solver/scene/simplify.h"
#include "solver/scene/track_keys.h"

namespace afterglow {

namespace {

/// Puts keys in the place of those that a target has in `tracks`.
template <class T>
void set_keys(std::vector<Track<T>>& tracks, Index target, std::vector<Key<T>> keys) {
    const auto known =
        std::find_if(tracks.begin(), tracks.end(), [&](const auto& track) { return track.target == target; });
    if (known != tracks.end())
        known->keys = std::move(keys);
    else
        tracks.push_back({target, std::move(keys)});
}

/// What a track in a document is for.
enum class Subject { node, material, camera };

/// A track in a document: its target and the members that belong to it.
struct Entry {
    JsonView view;
    Subject subject;
    JsonView name;
    KeyStyle style;

    [[nodiscard]] std::optional<JsonView> find(std::string_view key) const { return view.find(key); }
};

Entry entry_of(const JsonView& view, KeyStyle style) {
    if (const auto interpolation = view.find("interpolation")) {
        const std::string text = interpolation->as_string();
        if (text == "step")
            style.interpolation = KeyStyle::Interpolation::step;
        else if (text != "linear")
            interpolation->fail("expected \"linear\" or \"step\", found " + in_quotes(text));
    }
    if (const auto node = view.find("node")) {
        view.allow_only(
            {"node", "translation", "rotation", "emission_scale", "reflectance", "interpolation"});
        return {view, Subject::node, *node, style};
    }
    if (const auto material = view.find("material")) {
        view.allow_only({"material", "emission_scale", "reflectance", "interpolation"});
        return {view, Subject::material, *material, style};
    }
    if (const auto camera = view.find("camera")) {
        view.allow_only({"camera", "position", "look_at", "interpolation"});
        return {view, Subject::camera, *camera, style};
    }
    view.fail("a track needs a \"node\", a \"material\" or a \"camera\" that it is for");
}

class TrackAdder {
  public:
    TrackAdder(Scene& scene, KeyStyle style)
        : scene_(scene),
          style_(style),
          nodes_(scene.nodes, "node"),
          materials_(scene.materials, "material") {}

    void add(const JsonView& list) {
        std::vector<Entry> entries;
        for (const auto& view : list.elements()) entries.push_back(entry_of(view, style_));
        for (const Entry& entry : entries) {
            const bool is_empty = std::none_of(properties.begin(), properties.end(), [&](auto property) {
                return entry.find(property).has_value();
            });
            if (is_empty) entry.view.fail("says nothing that changes");
            if (entry.subject == Subject::node) move_node(entry);
            if (entry.subject == Subject::material) change_material(entry);
        }
        aim_cameras(entries);
        OwnMaterials own(scene_);
        for (const Entry& entry : entries)
            if (entry.subject == Subject::node) change_node_materials(entry, own);
    }

  private:
    static constexpr std::array<std::string_view, 6> properties{"translation", "rotation", "emission_scale",
                                                                "reflectance", "position", "look_at"};

    /// The keys of a property that one list may set only once for a target.
    std::optional<JsonView> once(const Entry& entry, std::string_view property, Index target) {
        auto keys = entry.find(property);
        if (keys && !seen_.emplace(entry.subject, property, target).second)
            keys->fail("is given a second time for the same target");
        return keys;
    }

    void move_node(const Entry& entry) {
        const Index node = nodes_.find(entry.name);
        if (const auto keys = once(entry, "translation", node))
            set_keys(scene_.tracks.node_translation, node, position_keys(*keys, entry.style));
        if (const auto keys = once(entry, "rotation", node))
            set_keys(scene_.tracks.node_rotation, node, rotation_keys(*keys, entry.style));
    }

    void change_material(const Entry& entry) {
        const Index material = materials_.find(entry.name);
        if (const auto keys = once(entry, "emission_scale", material))
            scale_emission({material}, *keys, entry);
        if (const auto keys = once(entry, "reflectance", material))
            set_keys(scene_.tracks.material_reflectance, material, colour_keys(*keys, entry.style));
    }

    void change_node_materials(const Entry& entry, OwnMaterials& own) {
        const Index node = nodes_.find(entry.name);
        const auto emission = once(entry, "emission_scale", node);
        const auto reflectance = once(entry, "reflectance", node);
        if (!emission && !reflectance) return;
        const auto materials = own.of(node);
        if (materials.empty()) entry.name.fail("the node has no surfaces");
        if (emission) scale_emission(materials, *emission, entry);
        if (!reflectance) return;
        for (const Index material : materials)
            set_keys(scene_.tracks.material_reflectance, material, colour_keys(*reflectance, entry.style));
    }

    void scale_emission(const std::vector<Index>& materials, const JsonView& keys, const Entry& entry) {
        const auto scales = scale_keys(keys, entry.style);
        bool shines = false;
        for (const Index material : materials) {
            if (!(max_channel(scene_.materials[material].emission) > 0)) continue;
            shines = true;
            set_keys(scene_.tracks.material_emission, material, scales);
        }
        if (!shines) keys.fail("it does not shine, so there is no emission to scale");
    }

    /// All that is said of a camera counts together, wherever it stands in the list.
    void aim_cameras(const std::vector<Entry>& entries) {
        std::map<Index, std::pair<CameraMotion, const Entry*>> cameras;
        for (const Entry& entry : entries) {
            if (entry.subject != Subject::camera) continue;
            const Index node = camera_node(scene_, entry.name);
            auto& [motion, last_entry] = cameras[node];
            last_entry = &entry;
            if (const auto keys = once(entry, "position", node))
                motion.position = position_keys(*keys, entry.style);
            if (const auto keys = once(entry, "look_at", node))
                motion.look_at = position_keys(*keys, entry.style);
        }
        for (const auto& [node, said] : cameras) move_camera(scene_, node, said.first, said.second->view);
    }

    Scene& scene_;
    KeyStyle style_;
    Names nodes_;
    Names materials_;
    std::set<std::tuple<Subject, std::string_view, Index>> seen_;
};

/// Puts a scene back as it was unless told to keep the changes. What tracks never change is not copied.
class Restorer {
  public:
    explicit Restorer(Scene& scene)
        : scene_(scene),
          materials_(scene.materials),
          nodes_(scene.nodes),
          tracks_(scene.tracks),
          warnings_(scene.warnings),
          meshes_(scene.meshes.size()),
          duration_s_(scene.duration_s) {}
    Restorer(const Restorer&) = delete;
    Restorer& operator=(const Restorer&) = delete;
    ~Restorer() {
        if (keep_) return;
        scene_.materials = std::move(materials_);
        scene_.nodes = std::move(nodes_);
        scene_.tracks = std::move(tracks_);
        scene_.warnings = std::move(warnings_);
        scene_.meshes.resize(meshes_);
        scene_.duration_s = duration_s_;
    }
    void keep() { keep_ = true; }

  private:
    Scene& scene_;
    std::vector<Material> materials_;
    std::vector<Node> nodes_;
    Tracks tracks_;
    Warnings warnings_;
    std::size_t meshes_;
    double duration_s_;
    bool keep_ = false;
};

}  // namespace

double seconds_per_unit(const JsonView& document, double frames_per_second) {
    const auto unit = document.find("time_unit");
    if (!unit || unit->as_string() == "s") return 1;
    if (unit->as_string() == "frame") return 1 / frames_per_second;
    unit->fail("expected \"s\" or \"frame\", found " + in_quotes(unit->as_string()));
}

void add_tracks(Scene& scene, const JsonView& tracks, double seconds_per_unit, double metres_per_unit) {
    TrackAdder(scene, {seconds_per_unit, metres_per_unit, KeyStyle::Interpolation::linear}).add(tracks);
}

void apply_paths(Scene& scene, std::string_view json_text, const std::string& name,
                 const LoadConfig& config) {
    const Json json = parse_json(json_text, name);
    const JsonView document(json, name);
    document.allow_only({"afterglow_paths", "time_unit", "tracks"});
    static_cast<void>(document.at("afterglow_paths").as_integer_in(1, 1));
    Restorer restorer(scene);
    add_tracks(scene, document.at("tracks"), seconds_per_unit(document, scene.frames_per_second), 1);
    try {
        validate(scene);
    } catch (const Error& e) {
        throw Error(e.kind(), name + ", " + e.place(), e.message());
    }
    simplify_tracks(scene.tracks, config);
    restorer.keep();
}

}  // namespace afterglow
