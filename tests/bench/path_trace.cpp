#include <cstdlib>
#include <iostream>
#include <string>

#include "solver/base/file.h"
#include "solver/image/path.h"
#include "solver/scene/load.h"
#include "solver/visibility/sight_lines.h"

// One frame of a scene by the path tracer: path_trace SCENE FRAME SAMPLES EDGE_PIXELS OUT.exr
// What pictures made from patches are measured beside.

namespace afterglow {
namespace {

constexpr float lamp_patch_m = 1;  // patches serve only to find the lamps

int run(const char* const* arguments) {
    const World world = assemble(load_scene(arguments[1]));
    const double time_s = std::atoi(arguments[2]) / world.frames_per_second;
    const int samples = std::atoi(arguments[3]), edge = std::atoi(arguments[4]);
    RayCaster caster(world);
    caster.set_poses(poses_at(world, time_s));
    Surfaces surfaces = find_surfaces(world, {.facet_size_m = lamp_patch_m});
    const SideMask all(surfaces.list.size(), {true, true});
    const PatchMesh mesh = make_patches(world, std::move(surfaces), all, {.patch_size_m = lamp_patch_m});
    std::vector<Material> materials;
    for (Index m = 0; m < world.materials.size(); ++m) materials.push_back(material_at(world, m, time_s));
    std::vector<Rgb> emission(mesh.size(), Rgb(0));
    for (Index p = 0; p < mesh.size(); ++p)
        if (is_emitter(world, mesh, p)) emission[p] = pi * materials[mesh.material(p)].emission;
    const Lamps lamps = find_lamps(world, mesh);
    const DirectLight direct(mesh, lamps, caster, emission);
    const auto lights = lights_at(world, time_s);
    const PathScene scene{&world, &caster, materials, &direct, lights, lift_for(world)};
    std::uint64_t rays = 0;
    const PathPicture made = trace_picture(view_at(world.cameras.front(), time_s, edge, edge), scene,
                                           {samples, 1, {}}, rays, Context());
    write_file(arguments[5], encode_exr(made.mean));
    std::cout << rays << " rays\n";
    return 0;
}

}  // namespace
}  // namespace afterglow

int main(int argc, char** argv) {
    if (argc != 6) {
        std::cerr << "usage: path_trace SCENE FRAME SAMPLES EDGE_PIXELS OUT.exr\n";
        return 2;
    }
    try {
        return afterglow::run(argv);
    } catch (const std::exception& error) {
        std::cerr << "path_trace: " << error.what() << '\n';
        return 1;
    }
}
