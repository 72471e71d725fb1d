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
/// light from. A lamp is chosen in proportion to a bound of what it can give; a point of it uniformly in
/// solid angle for rectangles near by, in area for the rest. Thread-safety: const after construction.
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

    /// The lamps as one point sees them: what all samples from there share. One thread at a time; to be used
    /// again for other points.
    struct Seen {
        Vec3 point{0}, normal{0};
        float sum = 0;                                        ///< of `bound`; 0: no lamp gives anything here
        std::vector<float> bound;                             ///< by emitter
        std::vector<std::optional<RectangleView>> rectangle;  ///< by emitter, made when first needed
    };
    void look_from(const Vec3& point, const Vec3& normal, Seen& seen) const;
    /// As above, from the point that was last looked from.
    [[nodiscard]] LightSample sample(Seen& seen, float choice, float s, float t) const;

    /// Whether the other's lamps stand where these do and shine alike; of the same lamps of the same mesh.
    [[nodiscard]] bool shines_like(const DirectLight& other) const;
    /// A box around each lamp that is on, world coordinates.
    [[nodiscard]] std::vector<Box> boxes() const;

  private:
    struct Emitter {
        Vec3 centre{0};
        float radius_m = 0;
        Rgb emission{0};  // radiosity
        float area_m2 = 0;
        std::optional<RectangleLight> rectangle;
        std::vector<Index> patches;           // where it is none
        std::vector<float> cumulative_share;  // of the area, by patch
        Pose pose;
    };
    [[nodiscard]] static float bound(const Emitter& emitter, const Vec3& point, const Vec3& normal);
    /// A point of the emitter, the normal there, and the solid angle it stands for (negative: seen from
    /// behind).
    struct Place {
        Vec3 position;
        float solid_angle;
    };
    [[nodiscard]] Place place_on(Index emitter, Seen& seen, float choice, float s, float t) const;

    const PatchMesh* mesh_;
    std::vector<Emitter> emitters_;
    SideMask covered_;  // sides of surfaces that are lamps
};

}  // namespace afterglow
