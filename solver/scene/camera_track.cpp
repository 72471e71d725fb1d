#include "solver/scene/camera_track.h"

#include <algorithm>
#include <string>
#include <utility>

#include "solver/scene/check_tracks.h"
#include "solver/scene/default_camera.h"
#include "solver/scene/moments.h"
#include "solver/scene/names.h"
#include "solver/scene/placement.h"

namespace afterglow {

namespace {

/// The name by which a node's camera goes.
struct CameraName {
    std::string name;
};

template <class T>
Track<T>& track_for(std::vector<Track<T>>& tracks, Index target) {
    const auto known =
        std::find_if(tracks.begin(), tracks.end(), [&](const auto& t) { return t.target == target; });
    if (known != tracks.end()) return *known;
    tracks.push_back({target, {}});
    return tracks.back();
}

/// Whether a node is a root that carries only its camera and is not scaled.
bool is_plain_root(const Scene& scene, Index node) {
    const Node& n = scene.nodes[node];
    const auto is_child = [&](const Node& other) { return other.parent == node; };
    return n.parent == no_index && n.mesh == no_index && n.light == no_index && n.local.scale == Vec3(1) &&
           std::none_of(scene.nodes.begin(), scene.nodes.end(), is_child);
}

/// Gives a camera a root node of its own that moves as its node did.
Index detached(Scene& scene, Index node) {
    const auto motions = motions_of(scene, 0, 0);
    const Path path = PathMaker(scene, motions, 0, 0).view_path(node);
    const auto own = static_cast<Index>(scene.nodes.size());
    Node root;
    root.name = scene.nodes[node].name + " (camera)";
    root.camera = std::exchange(scene.nodes[node].camera, no_index);
    root.local = {path.keys[0].value.translation, path.keys[0].value.rotation, Vec3(1)};
    scene.nodes.push_back(root);
    if (!path.moves()) return own;
    Track<Vec3> translation{own, {}};
    Track<Quat> rotation{own, {}};
    for (const auto& key : path.keys) {
        translation.keys.push_back({key.time_s, key.value.translation});
        rotation.keys.push_back({key.time_s, key.value.rotation});
    }
    scene.tracks.node_translation.push_back(std::move(translation));
    scene.tracks.node_rotation.push_back(std::move(rotation));
    return own;
}

/// Rotations of a camera at `positions` that looks at `targets`.
std::vector<Key<Quat>> following(const std::vector<Key<Vec3>>& positions,
                                 const std::vector<Key<Vec3>>& targets, double frames_per_second,
                                 const JsonView& place) {
    std::vector<Moment> moments;
    add_moments(moments, positions);
    add_moments(moments, targets);
    sort_moments(moments);
    if ((moments.back().time_s - moments.front().time_s) * frames_per_second > max_frames)
        throw Error(ErrorKind::too_large, place.place(), "the animation has more than a million frames");
    add_frames(moments, frames_per_second);
    std::vector<Key<Quat>> out;
    for (const Moment& moment : moments) {
        const Vec3 from = value_in<Vec3>(positions, moment.time_s, moment.side);
        const Vec3 to = value_in<Vec3>(targets, moment.time_s, moment.side);
        if (!(glm::length(to - from) > 1e-6F))
            place.fail("the camera stands in the point it looks at, at " + std::to_string(moment.time_s) +
                       " s");
        out.push_back({moment.time_s, looking_at(from, to)});
    }
    return out;
}

}  // namespace

Index camera_node(const Scene& scene, const JsonView& view) {
    std::vector<Index> holders;
    std::vector<CameraName> by_camera;
    std::vector<CameraName> by_node;
    for (Index n = 0; n < scene.nodes.size(); ++n) {
        if (scene.nodes[n].camera == no_index) continue;
        holders.push_back(n);
        by_camera.push_back({scene.cameras[scene.nodes[n].camera].name});
        by_node.push_back({scene.nodes[n].name});
    }
    const Names cameras(by_camera, "camera");
    const Names nodes(by_node, "camera");
    const std::string name = view.as_string();
    return holders[(nodes.contains(name) && !cameras.contains(name) ? nodes : cameras).find(view)];
}

void move_camera(Scene& scene, Index node, const CameraMotion& motion, const JsonView& place) {
    if (!is_plain_root(scene, node)) node = detached(scene, node);
    Tracks& tracks = scene.tracks;
    if (motion.position) track_for(tracks.node_translation, node).keys = *motion.position;
    if (!motion.look_at) return;
    const auto translation = std::find_if(tracks.node_translation.begin(), tracks.node_translation.end(),
                                          [&](const auto& track) { return track.target == node; });
    const std::vector<Key<Vec3>> positions =
        translation != tracks.node_translation.end()
            ? translation->keys
            : std::vector<Key<Vec3>>{{0, scene.nodes[node].local.translation}};
    track_for(tracks.node_rotation, node).keys =
        following(positions, *motion.look_at, scene.frames_per_second, place);
}

}  // namespace afterglow
