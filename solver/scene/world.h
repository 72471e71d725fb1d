#pragma once

#include <string>
#include <vector>

#include "solver/scene/scene.h"

namespace afterglow {

/// A rigid motion: rotation, then translation.
struct Pose {
    Vec3 translation{0};
    Quat rotation{1, 0, 0, 0};

    [[nodiscard]] Vec3 point(const Vec3& p) const { return rotation * p + translation; }
    [[nodiscard]] Vec3 direction(const Vec3& d) const { return rotation * d; }
    [[nodiscard]] Mat4 matrix() const;
    bool operator==(const Pose&) const = default;
};

/// Where a body is over time: poses at keys, linear (rotation: spherical) between them, constant outside. The
/// interior key times are the *knots*. Two keys at one time are a jump.
struct Path {
    std::vector<Key<Pose>> keys;  ///< empty: never moves

    [[nodiscard]] Pose at(double time_s) const;
    [[nodiscard]] bool moves() const { return keys.size() > 1; }
};

/// A rigid collection of triangles in its own frame. Body 0 is the furniture: everything static, joined, in
/// world coordinates. Every other body is an actor.
struct Body {
    std::string name;
    std::vector<Vec3> positions;
    std::vector<Vec2> texture_coordinates;  ///< one a position, (0,0) where the file had none
    std::vector<Triangle> triangles;
    Path path;
};
inline constexpr Index furniture = 0;

/// A named object among the furniture: triangles of body 0 that stand together there, with corners that no
/// other triangle uses.
struct FurniturePiece {
    std::string name;
    Index first_triangle = 0, triangles = 0;
};

/// A light without surface and where it is.
struct PlacedLight {
    Light light;
    Path path;  ///< at least one key
};

/// A camera and where it is.
struct PlacedCamera {
    Camera camera;
    Path path;  ///< at least one key
};

/// A scene made ready for solving: no hierarchy, no scale, furniture joined, actors apart.
struct World {
    std::string name;
    std::vector<Body> bodies;            ///< at least the furniture
    std::vector<FurniturePiece> pieces;  ///< of the furniture, in the order of its triangles
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Track<float>> material_emission;   ///< as in Tracks
    std::vector<Track<Rgb>> material_reflectance;  ///< as in Tracks
    std::vector<PlacedCamera> cameras;             ///< at least one
    std::vector<PlacedLight> lights;
    Rgb background{0};
    double frames_per_second = 24;
    double duration_s = 0;
    Warnings warnings;
};

/// Flattens a validated scene: static nodes join body 0; each node with a translation or rotation track of
/// its own, or under such a node, belongs to the actor of its nearest animated ancestor (or itself). Scale is
/// baked into the geometry. Collinear path keys are merged within the given tolerances. Errors: unsupported
/// where an actor's ancestors scale it unevenly while it turns. Thread-safety: pure.
World assemble(const Scene& scene, double tolerance_m = 1e-4, double tolerance_rad = 1e-4);

/// The material as it is at a time: tracks applied. Thread-safety: pure.
Material material_at(const World& world, Index material, double time_s);

}  // namespace afterglow
