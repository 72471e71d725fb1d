#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solver/base/math.h"
#include "solver/image/rectangle_light.h"
#include "solver/visibility/lamps.h"
#include "solver/visibility/ray_caster.h"

namespace afterglow {

/// What one chosen point of the lamps gives to a point if nothing stands between.
struct LightSample {
    Rgb irradiance{0};     ///< W/m², an unbiased estimate for all lamps together; 0: nothing to trace
    Vec3 direction{0};     ///< unit, towards the lamp
    float distance_m = 0;  ///< to the point on the lamp
};

/// The lamps of a scene at one time, ready to be sampled from any point: where a picture takes its direct
/// light from. A lamp is chosen nearly in proportion to what it gives if nothing stands between; a point of
/// it likewise where it is a rectangle, uniformly in area for the rest. Thread-safety: const after
/// construction.
class DirectLight {
  public:
    /// `emission` is radiosity by patch, W/m²; lamps stand where `placed` has their bodies.
    DirectLight(const PatchMesh& mesh, const Lamps& lamps, const RayCaster& placed,
                std::span<const Rgb> emission);

    /// Whether no lamp is on.
    [[nodiscard]] bool empty() const { return emitters_.empty(); }

    /// Whether what a ray met belongs to one of the lamps: its light comes by `sample`, so whoever takes both
    /// must not count it again.
    [[nodiscard]] bool covers(const Hit& hit) const;

    /// Seen from a point of a surface with a unit normal. `choice`, `s` and `t` in [0,1).
    [[nodiscard]] LightSample sample(const Vec3& point, const Vec3& normal, float choice, float s,
                                     float t) const;

    /// Whether the other's lamps stand where these do and shine alike; of the same lamps of the same mesh.
    [[nodiscard]] bool shines_like(const DirectLight& other) const;
    /// A box around each lamp that is on, world coordinates.
    [[nodiscard]] std::vector<Box> boxes() const;

    /// A lamp that is on.
    struct Emitter {
        Vec3 centre{0};
        float radius_m = 0;
        Rgb emission{0};  ///< radiosity, W/m²
        float area_m2 = 0;
        std::optional<RectangleLight> rectangle;  ///< world
        std::vector<Index> patches;               ///< where it is none
        std::vector<float> cumulative_share;      ///< of the area, by patch
        Pose pose;
    };
    [[nodiscard]] std::span<const Emitter> emitters() const { return emitters_; }

    /// A point of an emitter, and the solid angle it stands for.
    struct Place {
        Vec3 position{0};
        float solid_angle = 0;
    };
    /// On an emitter that is no rectangle, seen from a point.
    [[nodiscard]] Place place_on_patches(const Emitter& emitter, const Vec3& from, float choice, float s,
                                         float t) const;

  private:
    [[nodiscard]] static float weight(const Emitter& emitter, const Vec3& point, const Vec3& normal);

    const PatchMesh* mesh_;
    std::vector<Emitter> emitters_;
    SideMask covered_;  // sides of surfaces that are lamps
};

}  // namespace afterglow
