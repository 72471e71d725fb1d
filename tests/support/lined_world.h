#pragma once

#include "solver/visibility/static_pass.h"
#include "tests/support/worlds.h"

namespace afterglow::testing {

/// A world meshed on all sides, with its lines laid: what tests of visibility and form factors start from.
struct LinedWorld {
    World world;
    RayCaster caster;
    PatchMesh mesh;
    Lamps lamps;
    SightLines sight;
    LightLines light;

    LinedWorld(World w, float patch_size_m, Index lines_per_patch, Index light_lines_per_patch = 16)
        : world(std::move(w)),
          caster(world),
          mesh(mesh_all(world, patch_size_m)),
          lamps(find_lamps(world, mesh)),
          sight(mesh, world, lines_per_patch, 1),
          light(mesh, sight, lamps, light_lines_per_patch, 2) {}
    LinedWorld(const LinedWorld&) = delete;
    LinedWorld& operator=(const LinedWorld&) = delete;

    static PatchMesh mesh_all(const World& world, float size) {
        Surfaces surfaces = find_surfaces(world, {.facet_size_m = size});
        const SideMask all(surfaces.list.size(), {true, true});
        return make_patches(world, std::move(surfaces), all, {.patch_size_m = size});
    }
};

/// Radiosity of what its lamps emit, W/m², by patch.
inline std::vector<Rgb> emission_of(const LinedWorld& lined) {
    std::vector<Rgb> emission(lined.mesh.size(), Rgb(0));
    for (Index p = 0; p < lined.mesh.size(); ++p)
        if (is_emitter(lined.world, lined.mesh, p))
            emission[p] = pi * lined.world.materials[lined.mesh.material(p)].emission;
    return emission;
}

/// What its static lines see without actors.
inline StaticLines background_of(const LinedWorld& lined) {
    StaticLines lines = make_static_lines(lined.mesh, lined.sight, lined.light);
    extend_static_lines(lines, lined.mesh, lined.sight, lined.light, lined.caster,
                        lined.sight.lines_per_patch(), Context(2));
    return lines;
}

}  // namespace afterglow::testing
