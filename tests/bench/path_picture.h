#pragma once

#include <cstdint>
#include <utility>

#include "solver/image/path.h"
#include "solver/mesh/lift.h"
#include "solver/visibility/lamps.h"
#include "solver/visibility/sight_lines.h"

namespace afterglow {

/// A square picture of a world at some time, by paths alone; adds to `rays`.
inline PathPicture path_picture(const World& world, double time_s, int edge, int samples, std::uint64_t seed,
                                std::uint64_t& rays, const Context& context) {
    RayCaster caster(world);
    caster.set_poses(poses_at(world, time_s));
    // Patches serve only to find the lamps.
    Surfaces surfaces = find_surfaces(world, {.facet_size_m = 1});
    const SideMask all(surfaces.list.size(), {true, true});
    const PatchMesh mesh = make_patches(world, std::move(surfaces), all, {.patch_size_m = 1});
    std::vector<Material> materials;
    for (Index m = 0; m < world.materials.size(); ++m) materials.push_back(material_at(world, m, time_s));
    std::vector<Rgb> emission(mesh.size(), Rgb(0));
    for (Index p = 0; p < mesh.size(); ++p)
        if (is_emitter(world, mesh, p)) emission[p] = pi * materials[mesh.material(p)].emission;
    const Lamps lamps = find_lamps(world, mesh);
    const DirectLight direct(mesh, lamps, caster, emission);
    const auto lights = lights_at(world, time_s);
    const PathScene scene{&world, &caster, materials, &direct, lights, lift_for(world)};
    return trace_picture(view_at(world.cameras.front(), time_s, edge, edge), scene, {samples, seed, {}}, rays,
                         context);
}

}  // namespace afterglow
