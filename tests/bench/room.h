#pragma once

#include <utility>
#include <vector>

#include "solver/formfactor/layered_matrix.h"
#include "solver/radiosity/problem.h"
#include "solver/visibility/reach.h"
#include "solver/visibility/strategy.h"

namespace afterglow {

/// A world in even patches with their lines, all that a bench of visibility needs. Its parts point at each
/// other.
struct LinedRoom {
    World world;
    RayCaster caster;
    PatchMesh mesh;
    Lamps lamps;
    SightLines sight;
    LightLines light;
    StaticLines background;

    LinedRoom(World w, float patch_size_m, Index lines, Index light_lines)
        : world(std::move(w)),
          caster(world),
          mesh(meshed(patch_size_m)),
          lamps(find_lamps(world, mesh)),
          sight(mesh, world, lines, 1),
          light(mesh, sight, lamps, light_lines, 2),
          background(make_static_lines(mesh, sight, light)) {}
    LinedRoom(const LinedRoom&) = delete;
    LinedRoom& operator=(const LinedRoom&) = delete;

    [[nodiscard]] LineScene lines(int frame) const { return {mesh, sight, light, caster, background, frame}; }
    [[nodiscard]] DirectionRange all() const { return {0, sight.lines_per_patch()}; }

  private:
    PatchMesh meshed(float patch_size_m) {
        Surfaces surfaces = find_surfaces(world);
        const SideMask reached = reachable_sides(world, surfaces, caster, {}, Context());
        return make_patches(world, std::move(surfaces), reached, {.patch_size_m = patch_size_m});
    }
};

/// With what patches emit and reflect at time 0: what a bench of light needs.
struct LitRoom : LinedRoom {
    std::vector<Rgb> emission, reflectance, external;

    LitRoom(World w, float patch_size_m, Index lines, Index light_lines)
        : LinedRoom(std::move(w), patch_size_m, lines, light_lines), external(mesh.size(), Rgb(0)) {
        for (Index p = 0; p < mesh.size(); ++p) {
            const Material& material = world.materials[mesh.material(p)];
            emission.push_back(is_emitter(world, mesh, p) ? pi * material.emission : Rgb(0));
            reflectance.push_back(material.reflectance * mesh.texture_mean[p]);
        }
    }
    [[nodiscard]] LayerScene layers() const { return {mesh, sight, light, lamps, caster, background}; }
    [[nodiscard]] RadiosityProblem problem(const FormFactorMatrix& matrix) const {
        return {matrix, mesh.area_m2, emission, reflectance, external};
    }
};

}  // namespace afterglow
