// One part of the solver on one scene, every way there is to do its work, for the assessment: prints a JSON
// object a line. Usage: parts_cell lines|factors|orders|certificates SCENE [patch size, m] [lines a patch]
// [seed]

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "solver/scene/load.h"
#include "tests/bench/assess/parts.h"

namespace afterglow {
namespace {

int run(int count, char** arguments) {
    if (count < 3)
        throw std::invalid_argument(
            "usage: parts_cell lines|factors|orders|certificates SCENE [patch size, m] [lines] [seed]");
    PartScene scene{assemble(load_scene(arguments[2]))};
    if (count > 3) scene.patch_size_m = static_cast<float>(std::atof(arguments[3]));
    if (count > 4) scene.rays = static_cast<Index>(std::atoi(arguments[4]));
    if (count > 5) scene.seed = std::strtoull(arguments[5], nullptr, 10);
    const PartRows print = [](const Json& row) {
        std::printf("%s\n", row.dump().c_str());
        std::fflush(stdout);
    };
    const std::string_view part = arguments[1];
    if (part == "lines")
        measure_lines(scene, print);
    else if (part == "factors")
        measure_factors(scene, print);
    else if (part == "orders")
        measure_orders(scene, print);
    else if (part == "certificates")
        measure_certificates(scene, print);
    else
        throw std::invalid_argument("there is no part \"" + std::string(part) + "\"");
    return 0;
}

}  // namespace
}  // namespace afterglow

int main(int count, char** arguments) {
    try {
        return afterglow::run(count, arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "parts_cell: %s\n", error.what());
        return 1;
    }
}
