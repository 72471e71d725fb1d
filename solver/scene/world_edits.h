#pragma once

#include <string>
#include <vector>

#include "solver/scene/world.h"

namespace afterglow {

// Changes of a world by the names of its scene; those of the furniture are in furniture.h. Errors of all:
// not_found, listing the names there are; invalid_input naming the value; the world is as before then.
// Each returns the number of what it changed.

/// What a material emits, W/m²/sr per channel in [0, 1e6), at all times: its track, if any, is dropped.
Index set_emission(World& world, const std::string& material, const Rgb& emission);

/// The lamps without surface of a name; in a scene one lamp may stand in several places. Errors: not_found.
std::vector<Index> lamps_named(const World& world, const std::string& name);

/// How strongly all of them shine, W/sr per channel in [0, 1e6), directional ones W/m². Returns the first
/// one.
Index set_intensity(World& world, const std::string& lamp, const Rgb& intensity);

/// What share of light a material reflects, each channel in [0, 1), likewise.
Index set_reflectance(World& world, const std::string& material, const Rgb& reflectance);

/// Where an actor goes from a time on: keys of `path` before it are left out, and so are those of its old
/// path from then on; between the two is a jump.
Index set_path(World& world, const std::string& actor, double from_s, const Path& path);

/// A path by keys of its position and of its rotation; where there are none of one, it is as in `old`.
Path with_keys(const Path& old, const std::vector<Key<Vec3>>& translation,
               const std::vector<Key<Quat>>& rotation);

/// How an object is moved from where it is, in world coordinates.
struct Shift {
    Vec3 translation{0};
    Quat rotation{1, 0, 0, 0};  ///< about the object's own middle, before the translation
};

/// The rigid motion that a shift of a piece of furniture is, as it stands: its middle is that of its bounds.
Pose motion_of(const World& world, Index piece, const Shift& shift);

/// The path of an actor that is shifted at all times: its middle is the origin of its own frame.
Path shifted(const Path& path, const Shift& shift);

}  // namespace afterglow
