#include <cstdlib>
#include <iostream>
#include <string>

#include "solver/base/file.h"
#include "solver/scene/load.h"
#include "tests/bench/path_picture.h"

// One frame of a scene by the path tracer: path_trace SCENE FRAME SAMPLES EDGE_PIXELS OUT.exr [SEED]
// What pictures made from patches are measured beside.

namespace afterglow {
namespace {

int run(int count, const char* const* arguments) {
    const World world = assemble(load_scene(arguments[1]));
    const double time_s = std::atoi(arguments[2]) / world.frames_per_second;
    const int samples = std::atoi(arguments[3]), edge = std::atoi(arguments[4]);
    const std::uint64_t seed = count > 6 ? std::strtoull(arguments[6], nullptr, 10) : 1;
    std::uint64_t rays = 0;
    const PathPicture made = path_picture(world, time_s, edge, samples, seed, rays, Context(1));
    write_file(arguments[5], encode_exr(made.mean));
    std::cout << rays << " rays\n";
    return 0;
}

}  // namespace
}  // namespace afterglow

int main(int argc, char** argv) {
    if (argc != 6 && argc != 7) {
        std::cerr << "usage: path_trace SCENE FRAME SAMPLES EDGE_PIXELS OUT.exr [SEED]\n";
        return 2;
    }
    try {
        return afterglow::run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "path_trace: " << error.what() << '\n';
        return 1;
    }
}
