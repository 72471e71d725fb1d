#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "solver/base/error.h"
#include "solver/base/math.h"

namespace afterglow {

/// A base-colour picture as stored in its file: sRGB-coded, 8 bits a channel, row by row from the top left.
struct Texture {
    std::string name;
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  ///< width × height × 4

    /// Linear colour at texture coordinates (u to the right, v downwards, repeating), bilinear between
    /// texels.
    [[nodiscard]] Rgb at(const Vec2& uv) const;
};

/// A diffuse surface that may also shine.
struct Material {
    std::string name;
    Rgb reflectance{0.8F};  ///< linear, each channel in [0, 1); multiplied by the texture where there is one
    Index texture = no_index;  ///< into Scene::textures
    Rgb emission{0};           ///< emitted radiance, W/m²/sr per channel, ≥ 0
    enum class Shines { front, both } shines = Shines::front;  ///< which sides emit; every side reflects
};

/// Three vertices, counter-clockwise seen from the front, and what they are made of.
struct Triangle {
    std::array<Index, 3> vertices{};
    Index material = 0;
};

/// Triangles in a node's own coordinates.
struct Mesh {
    std::string name;
    std::vector<Vec3> positions;            ///< metres
    std::vector<Vec2> texture_coordinates;  ///< one a position, or empty
    std::vector<Triangle> triangles;
};

/// Translation · rotation · scale, applied right to left.
struct Transform {
    Vec3 translation{0};
    Quat rotation{1, 0, 0, 0};
    Vec3 scale{1};

    [[nodiscard]] Mat4 matrix() const;
};

/// A place in the hierarchy. Parents stand before their children in Scene::nodes.
struct Node {
    std::string name;
    Index parent = no_index;
    Transform local;
    Index mesh = no_index;
    Index camera = no_index;
    Index light = no_index;
};

/// A perspective camera looking along its node's −z, y up. The picture size gives the aspect.
struct Camera {
    std::string name;
    float vertical_angle = 0.7F;  ///< full angle, radians, in (0, π)
};

/// A light without a surface (KHR_lights_punctual), shining along its node's −z where it has a direction.
struct Light {
    enum class Kind { point, spot, directional };
    std::string name;
    Kind kind = Kind::point;
    Rgb intensity{0};                 ///< point, spot: W/sr; directional: irradiance, W/m²
    float inner_cone_angle = 0;       ///< half angle, radians: full intensity within
    float outer_cone_angle = pi / 4;  ///< half angle, radians: none without
};

/// A value at a time. Two keys at one time are a jump; at that time the later one holds.
template <class T>
struct Key {
    double time_s = 0;
    T value{};
};

/// A value over time: linear between keys (spherical for rotations), constant before the first and after the
/// last.
template <class T>
struct Track {
    Index target = no_index;   ///< a node or a material, see Tracks
    std::vector<Key<T>> keys;  ///< at least one; times never decrease
};

/// Everything that changes over time. At most one track of a kind for one target.
struct Tracks {
    std::vector<Track<Vec3>> node_translation;     ///< replaces Node::local.translation
    std::vector<Track<Quat>> node_rotation;        ///< replaces Node::local.rotation
    std::vector<Track<float>> material_emission;   ///< multiplies Material::emission, ≥ 0
    std::vector<Track<Rgb>> material_reflectance;  ///< replaces Material::reflectance, each channel in [0, 1)
};

/// What a file says: a hierarchy of nodes and their tracks, units in metres and seconds.
/// Invariants (checked by `validate`): every index is in range, every number finite, reflectances in [0, 1).
struct Scene {
    std::string name;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    Tracks tracks;
    Rgb background{0};  ///< radiance of lines that leave the scene
    double frames_per_second = 24;
    double duration_s = 0;  ///< of the animation: the last key's time
    Warnings warnings;      ///< what the reader had to leave out or interpret
};

/// Value of a track at a time. Thread-safety: pure.
Vec3 value_at(const Track<Vec3>& track, double time_s);
Quat value_at(const Track<Quat>& track, double time_s);
float value_at(const Track<float>& track, double time_s);

}  // namespace afterglow
