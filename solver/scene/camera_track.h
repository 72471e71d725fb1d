#pragma once

#include <optional>
#include <vector>

#include "solver/base/json.h"
#include "solver/scene/scene.h"

namespace afterglow {

/// How a camera moves, in world coordinates; what is absent stays as it is.
struct CameraMotion {
    std::optional<std::vector<Key<Vec3>>> position;
    std::optional<std::vector<Key<Vec3>>> look_at;
};

/// The node that shows the camera named in `view`: by the camera's name, or else by the node's.
/// Errors: invalid_input at the view for a name that no camera or more than one has.
Index camera_node(const Scene& scene, const JsonView& view);

/// Replaces the tracks of a camera's node. A camera below another node, or on a node that carries more than
/// the camera, first gets a node of its own at the root, since the motion is in world coordinates.
/// Directions are sampled at the scene's frame rate between keys, as a camera that follows a point does not
/// turn evenly. `place` names the track in errors.
/// Errors: invalid_input where the camera and the point it looks at meet; too_large for more than a million
/// frames.
void move_camera(Scene& scene, Index node, const CameraMotion& motion, const JsonView& place);

}  // namespace afterglow
