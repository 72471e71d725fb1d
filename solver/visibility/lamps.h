#pragma once

#include <vector>

#include "solver/mesh/patch_mesh.h"

namespace afterglow {

/// A small shining surface side. Cosine-weighted lines meet it by luck only, so receivers sample it by lines
/// of their own.
struct Lamp {
    Index body = 0;
    Vec3 centre{0};      ///< body frame
    float radius_m = 0;  ///< of a ball around the centre that holds it
    float area_m2 = 0;
    std::vector<Index> patches;
};

/// All lamps of a scene and which patch belongs to which.
struct Lamps {
    std::vector<Lamp> list;
    std::vector<Index> lamp_of_patch;     ///< no_index for patches of no lamp
    std::vector<Index> patches;           ///< of all lamps
    std::vector<float> cumulative_power;  ///< by entry of `patches`, the last is 1
};

struct LampConfig {
    /// A shining surface larger than this share of all patches is met often enough by ordinary lines.
    float largest_share = 0.1F;
    /// So is one whose emission is less than this many times the mean over all patches: where everything
    /// shines, nothing is a lamp.
    float least_contrast = 4;
    /// A lamp whose solid angle as seen from a patch is more than this share of the hemisphere is sampled by
    /// ordinary lines there.
    float near_share = 0.3F;
};

/// Finds the lamps among a mesh's patches. Thread-safety: pure.
Lamps find_lamps(const World& world, const PatchMesh& mesh, const LampConfig& config = {});

/// Whether a lamp is so near a point that ordinary lines sample it better; both in the lamp's frame.
bool is_near(const Lamp& lamp, const Vec3& point, const LampConfig& config);

/// Shining patches: emission above zero on a side that shines. Tracks are not considered (a lamp that is off
/// is still a lamp).
bool is_emitter(const World& world, const PatchMesh& mesh, Index patch);

}  // namespace afterglow
