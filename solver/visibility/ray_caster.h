#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "solver/mesh/patch_mesh.h"
#include "solver/scene/world.h"

namespace afterglow {

/// A ray in world coordinates.
struct Ray {
    Vec3 origin{0};
    Vec3 direction{0, 0, 1};                             ///< unit
    float far = std::numeric_limits<float>::infinity();  ///< metres; nothing beyond is seen
};

/// The nearest surface along a ray. `body` is no_index where nothing was hit.
struct Hit {
    Index body = no_index;
    Index triangle = no_index;
    Side side = Side::front;
    float distance = std::numeric_limits<float>::infinity();  ///< metres
    float u = 0, v = 0;  ///< barycentric weights of the triangle's second and third vertex
};

/// Sixteen rays traced together. Lanes at or past `count` are not traced.
struct RayPacket {
    alignas(64) std::array<float, 16> origin_x, origin_y, origin_z;
    alignas(64) std::array<float, 16> direction_x, direction_y, direction_z;
    alignas(64) std::array<float, 16> far;
    Index count = 0;

    void set(std::size_t lane, const Ray& ray) {
        origin_x[lane] = ray.origin.x;
        origin_y[lane] = ray.origin.y;
        origin_z[lane] = ray.origin.z;
        direction_x[lane] = ray.direction.x;
        direction_y[lane] = ray.direction.y;
        direction_z[lane] = ray.direction.z;
        far[lane] = ray.far;
    }
    [[nodiscard]] Ray ray(std::size_t lane) const {
        return {Vec3(origin_x[lane], origin_y[lane], origin_z[lane]),
                Vec3(direction_x[lane], direction_y[lane], direction_z[lane]), far[lane]};
    }
};
using HitPacket = std::array<Hit, 16>;

/// What a ray is traced against.
enum class Scope {
    static_geometry,  ///< body 0
    actors,           ///< all other bodies, at their current poses
    everything,       ///< both
};

/// Traces rays against a world's triangles, both sides of each. The only part of the program that knows
/// Embree. The furniture's structure is built once; actors are placed anew by `set_poses`, which is cheap.
/// Thread-safety: tracing is const and may come from any number of threads, but not during set_poses.
class RayCaster {
  public:
    /// Keeps a copy of nothing but the geometry. Errors: std::bad_alloc where memory for the structure cannot
    /// be had.
    explicit RayCaster(const World& world);
    RayCaster(RayCaster&&) noexcept;
    RayCaster& operator=(RayCaster&&) noexcept;
    ~RayCaster();

    /// Where every body stands from now on; one pose a body, the furniture's is not used.
    void set_poses(std::span<const Pose> poses);
    [[nodiscard]] const Pose& pose(Index body) const;

    /// Of actors in a tie the one of the lowest number, see tie.h.
    [[nodiscard]] Hit nearest(const Ray& ray, Scope scope) const;
    [[nodiscard]] bool occluded(const Ray& ray, Scope scope) const;

    /// The same for neighbouring rays; fastest where they run nearly parallel.
    void nearest(const RayPacket& rays, Scope scope, HitPacket& hits) const;
    /// Bit k of the result: lane k is occluded before its `far`.
    [[nodiscard]] std::uint32_t occluded(const RayPacket& rays, Scope scope) const;

    /// The same for lines of an actor's surface, against everything: the actor hides what touches it.
    void nearest_from(Index actor, const RayPacket& rays, HitPacket& hits) const;

    /// The same against one body alone. The rays are in the body's frame, wherever it stands.
    void nearest(const RayPacket& rays, Index body, HitPacket& hits) const;
    [[nodiscard]] std::uint32_t occluded(const RayPacket& rays, Index body) const;

  private:
    void nearest_in(const RayPacket& rays, Scope scope, HitPacket& hits) const;

    struct Scenes;
    std::unique_ptr<Scenes> scenes_;
};

/// Where every body of a world stands at a time.
std::vector<Pose> poses_at(const World& world, double time_s);

}  // namespace afterglow
