#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "solver/base/json.h"
#include "solver/scene/world_edits.h"

namespace afterglow {

// What a client may change of a job that has been submitted, by the names of its scene. Values.

/// Moves a piece of furniture, or an actor along all of its path, from where it is.
struct MoveEdit {
    std::string node;
    Shift shift;
};

/// How brightly the surfaces of a material shine, or the lamps without surface of a name.
struct LightEdit {
    enum class Of { material, lamp, either };
    Of of = Of::material;  ///< `either` only until resolved
    std::string name;
    /// W/m²/sr of a material, W/sr of a lamp, W/m² of a directional one; absent only until resolved.
    std::optional<Rgb> light;
    std::optional<double> scale;  ///< times what it is in the scene, as the client gave it
};

/// What share of light a material reflects.
struct MaterialEdit {
    std::string material;
    Rgb reflectance{0};
};

/// Through which of the scene's cameras pictures are taken, or from where by that camera.
struct CameraEdit {
    std::optional<std::string> camera;  ///< the job's own where absent
    struct View {
        Vec3 position{0}, look_at{0};  ///< differ
    };
    std::optional<View> view;  ///< the camera's own path where absent
};

/// Where an actor goes from a time on, in world coordinates; of what has no keys the old path goes on.
struct PathEdit {
    std::string node;
    double from_s = 0;
    std::vector<Key<Vec3>> translation;
    std::vector<Key<Quat>> rotation;
};

/// Takes a piece of furniture away.
struct RemoveEdit {
    std::string node;
};

/// Adds a piece of furniture of one material.
struct AddEdit {
    Body object;  ///< positions in world coordinates; the material of its triangles is `material`
    std::string material;
};

/// One change, and the JSON that it was read from, which reads as the same again.
struct Edit {
    std::variant<MoveEdit, LightEdit, MaterialEdit, CameraEdit, PathEdit, RemoveEdit, AddEdit> what;
    Json source;
};

/// The edits of one request, which count together as one revision of their job.
struct JobEdit {
    std::vector<Edit> edits;
    int first_frame = 0;           ///< pictures from this frame on show what is no more
    std::optional<double> reused;  ///< share of lines that the running job kept, in [0, 1]; once applied
};

/// Settles what depends on the uploaded scene alone: what a light edit is of, and how bright that becomes.
/// Errors: not_found; invalid_input: "name" where a material that shines and a lamp both have it;
/// "emission_scale" for a material that emits nothing there, "intensity_scale" for lamps that are off there
/// or of several strengths, both "scale" where only a name was given.
void resolve(Edit& edit, const World& uploaded);

/// Changes a world as an edit says; a camera edit changes nothing there. Errors: those of world_edits.h and
/// furniture.h; the world is then as before.
void apply(World& world, const Edit& edit);

/// The path that a PathEdit means for an actor in `world`.
Path path_of(const World& world, const PathEdit& edit);
/// The path of an actor moved by `shift` in `world`. Errors: not_found.
Path path_of(const World& world, const MoveEdit& edit);
/// Whether a node of that name is furniture. Errors: not_found where it is no actor either.
enum class ObjectKind { piece, actor };
ObjectKind kind_of(const World& world, const std::string& node);
/// An AddEdit's object with the number of its material. Errors: not_found.
Body object_of(const World& world, const AddEdit& edit);
/// The camera that an edit chooses, where the job was submitted with `camera` (empty: the first). Errors:
/// not_found.
PlacedCamera camera_of(const World& world, const std::string& camera, const CameraEdit& edit);

/// The first frame that an edit changes, of a job whose first frame is `first`.
int first_frame_changed(const Edit& edit, int first, double frames_per_second);

}  // namespace afterglow
