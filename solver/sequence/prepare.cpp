#include "solver/sequence/prepare.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/base/stopwatch.h"
#include "solver/formfactor/static_cache.h"
#include "solver/sequence/quality.h"
#include "solver/visibility/coarseness.h"
#include "solver/visibility/reach.h"

namespace afterglow {

namespace {

// Over an animation, at which furniture is judged by how near its actors come. More do not make better
// pictures.
constexpr int moments_of_actors = 8;

void require(bool holds, const char* setting, const char* rule) {
    if (!holds) throw Error(ErrorKind::invalid_input, setting, rule);
}

Index rounded_up(int rays) {
    return static_cast<Index>((rays + 15) / 16 * 16);
}

float area_of_all(const World& world) {
    float area = 0;
    for (const Body& body : world.bodies)
        for (Index t = 0; t < body.triangles.size(); ++t)
            area += 0.5F * glm::length(doubled_area_normal(body, t));
    return area;
}

float reached_area(const Surfaces& surfaces, const SideMask& reached) {
    float area = 0;
    for (std::size_t s = 0; s < surfaces.list.size(); ++s)
        area += surfaces.list[s].area_m2 * static_cast<float>(int{reached[s][0]} + int{reached[s][1]});
    return area;
}

}  // namespace

void check(const SequenceConfig& config) {
    require(!config.rays_per_patch || (*config.rays_per_patch >= 16 && *config.rays_per_patch <= 65536),
            "rays", "must be from 16 to 65536");
    require(!config.patch_size_m || (*config.patch_size_m > 0 && std::isfinite(*config.patch_size_m)),
            "patch_size", "must be above 0 metres");
    require(!config.asked_error || (*config.asked_error > 0 && *config.asked_error < 1), "error",
            "must lie between 0 and 1");
    require(!config.made_for_error || (*config.made_for_error > 0 && *config.made_for_error < 1),
            "made_for_error", "must lie between 0 and 1");
    require(!config.picture_tolerance ||
                (*config.picture_tolerance >= 0 && std::isfinite(*config.picture_tolerance)),
            "picture_tolerance", "must be 0 or more");
    require(config.width >= 1 && config.width <= 16384 && config.height >= 1 && config.height <= 16384,
            "size", "must be from 1 to 16384 pixels each way");
    require(config.frames_per_second >= 0 && std::isfinite(config.frames_per_second), "fps",
            "must be above 0");
    require(config.frames_looked_ahead >= 1 && config.frames_looked_ahead <= 4096, "frames_looked_ahead",
            "must be from 1 to 4096");
    require(config.frames_expected >= 0, "frames_expected", "must be 0 or more");
    require(!config.exposure_ev || std::abs(*config.exposure_ev) <= 64, "exposure",
            "must be from -64 to 64 stops");
}

PlacedCamera find_camera(const World& world, const std::string& name) {
    if (name.empty()) return world.cameras.front();
    std::string names;
    for (const PlacedCamera& camera : world.cameras) {
        if (camera.camera.name == name) return camera;
        names += (names.empty() ? "" : ", ") + camera.camera.name;
    }
    throw Error(ErrorKind::not_found, "camera", "there is no camera \"" + name + "\"; there are: " + names);
}

namespace {

/// How far apart patches are expected to be before it is known which sides get any.
float first_guess_m(SequenceState::Parts& parts) {
    if (const auto asked = parts.config.patch_size_m) return static_cast<float>(*asked);
    if (!parts.guessed_size_m)
        parts.guessed_size_m = std::sqrt(area_of_all(parts.world) / level_of(parts.config).cells);
    return *parts.guessed_size_m;
}

/// How far apart they are, once that is known.
float patch_size_m(SequenceState::Parts& parts, const Surfaces& surfaces) {
    if (const auto asked = parts.config.patch_size_m) return static_cast<float>(*asked);
    if (!parts.patch_size_m)
        parts.patch_size_m = std::sqrt(reached_area(surfaces, parts.reached) / level_of(parts.config).cells);
    return *parts.patch_size_m;
}

SideMask find_reached(SequenceState::Parts& parts, const Surfaces& surfaces, const Context& context) {
    ReachConfig reach;
    reach.spacing_m = first_guess_m(parts);
    reach.seed = parts.config.seed;
    return reachable_sides(parts.world, surfaces, parts.caster, reach, context);
}

/// Patches for the sides that light can reach: even ones of the asked size, or as fine as they must be.
PatchMesh mesh_reached(SequenceState::Parts& parts, const Context& context) {
    const World& world = parts.world;
    const QualityLevel level = level_of(parts.config);
    const auto asked = parts.config.patch_size_m;
    const Surfaces surfaces = find_surfaces(world, {.facet_size_m = first_guess_m(parts)});
    parts.reached = find_reached(parts, surfaces, context);
    MeshConfig mesh;
    mesh.patch_size_m = patch_size_m(parts, surfaces);
    if (asked || level.finest_share >= 1) return make_patches(world, surfaces, parts.reached, mesh, context);

    parts.caster.set_poses(poses_at(world, 0));
    CoarsenessConfig coarseness;
    coarseness.size_per_distance = level.size_per_distance;
    coarseness.seed = parts.config.seed;
    // A hair less, so that halving a whole number of times reaches it.
    mesh.finest_m = 0.999F * level.finest_share * mesh.patch_size_m;
    mesh.is_too_coarse = Coarseness(parts.caster, surfaces, parts.reached, lift_for(world), coarseness,
                                    passing_actors(world, moments_of_actors));
    return make_patches(world, surfaces, parts.reached, mesh, context);
}

}  // namespace

void mesh_world(SequenceState::Parts& parts, const Context& context) {
    divide_world(parts, context);
    lay_lines(parts);
}

void divide_world(SequenceState::Parts& parts, const Context& context) {
    PatchMesh mesh = mesh_reached(parts, context);
    if (mesh.size() == 0)
        throw Error(ErrorKind::invalid_input, parts.world.name, "no surface can be reached by light or seen");
    parts.mesh = std::move(mesh);
}

void lay_lines(SequenceState::Parts& parts) {
    const World& world = parts.world;
    parts.interpolation.emplace(world, parts.mesh);
    parts.normals.emplace(world, parts.mesh.surfaces);
    parts.lamps = find_lamps(world, parts.mesh);
    const Index rays = rounded_up(level_of(parts.config).rays_per_patch);
    parts.sight.emplace(parts.mesh, world, rays, parts.config.seed);
    lay_light_lines(parts);
    parts.statistics.patches = parts.mesh.size();
    parts.statistics.actor_patches = parts.mesh.size() - parts.mesh.static_size();
    parts.statistics.rays_per_patch = static_cast<int>(rays);
}

bool reaches_more(SequenceState::Parts& parts, const Context& context) {
    const SideMask now = find_reached(parts, parts.mesh.surfaces, context);
    for (std::size_t surface = 0; surface < now.size(); ++surface)
        for (const std::size_t side : {0U, 1U})
            if (now[surface][side] && !parts.reached[surface][side]) return true;
    return false;
}

void lay_light_lines(SequenceState::Parts& parts) {
    const Index light_lines = std::clamp(parts.sight->lines_per_patch() / 4, Index{16}, Index{256});
    parts.light.emplace(parts.mesh, *parts.sight, parts.lamps, light_lines, mixed(parts.config.seed));
    parts.visible = make_visible_lines(parts.mesh, *parts.sight, *parts.light);
    parts.statistics.sight_lines = parts.visible.patch.size() + parts.visible.light_contribution.size();
}

std::uint64_t advance_static_pass(SequenceState::Parts& parts, Index directions, const Context& context) {
    const Stopwatch watch;
    const auto& folder = parts.config.cache_folder;
    if (parts.background.background.patch.empty()) {
        parts.background = make_static_lines(parts.mesh, *parts.sight, *parts.light);
        parts.background_key = static_key(parts.world, parts.mesh, *parts.sight, parts.lamps,
                                          parts.light->lines_per_patch(), parts.config.seed);
        if (!folder.empty()) {
            auto kept = load_static_lines(folder, parts.background_key, parts.mesh,
                                          parts.sight->lines_per_patch(), parts.light->lines_per_patch());
            if (kept) parts.background = std::move(*kept);
            parts.statistics.static_from_cache = kept.has_value();
        }
    }
    std::uint64_t rays = 0;
    if (parts.background.directions < directions) {
        context.report(0, "tracing the static sight lines");
        rays = extend_static_lines(parts.background, parts.mesh, *parts.sight, *parts.light, parts.caster,
                                   directions, context);
        if (!folder.empty() && directions == parts.sight->lines_per_patch()) {
            try {
                save_static_lines(folder, parts.background_key, parts.background);
            } catch (const Error& error) {
                parts.warnings.push_back(
                    {error.place(), "the static pass could not be kept for later: " + error.message()});
            }
        }
    }
    parts.statistics.static_pass += watch.elapsed();
    return rays;
}

}  // namespace afterglow
