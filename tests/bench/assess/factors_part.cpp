#include <cmath>
#include <string>

#include "solver/formfactor/method.h"
#include "tests/bench/assess/parts.h"
#include "tests/bench/room.h"
#include "tests/bench/timing.h"

namespace afterglow {
namespace {

constexpr Index rows_measured = 12;
constexpr Index truth_lines = 65'536;

struct Way {
    std::string name;
    std::unique_ptr<FormFactorMethod> method;
    std::vector<double> ms = {};
    double square = 0;
};

double squared_difference(const FormFactorRow& row, const FormFactorRow& truth) {
    double sum = 0;
    for (std::size_t j = 0; j < truth.factor.size(); ++j)
        sum += (row.factor[j] - truth.factor[j]) * (row.factor[j] - truth.factor[j]);
    return sum;
}

std::unique_ptr<FormFactorMethod> hemicube(int resolution, Index points) {
    HemicubeMethodConfig config;
    config.hemicube.resolution = resolution;
    config.points_per_edge = points;
    return make_hemicube(config);
}

}  // namespace

void measure_factors(const PartScene& scene, const PartRows& print) {
    LinedRoom room(scene.world, scene.patch_size_m, scene.rays, 1);
    room.caster.set_poses(poses_at(room.world, 0));
    const SightLines many(room.mesh, room.world, truth_lines, scene.seed + 100);
    const auto truth = make_ray_cast(many);
    std::vector<std::unique_ptr<SightLines>> lines;
    std::vector<Way> ways;
    for (const Index count : {128U, 512U, 2048U}) {
        lines.push_back(std::make_unique<SightLines>(room.mesh, room.world, count, scene.seed));
        ways.push_back({"ray cast, " + std::to_string(count), make_ray_cast(*lines.back())});
    }
    for (const int resolution : {32, 64, 128, 256})
        ways.push_back({"hemicube, " + std::to_string(resolution), hemicube(resolution, 1)});
    ways.push_back({"hemicube, 64, 4 × 4 points", hemicube(64, 4)});
    for (const Index count : {4U, 32U})
        ways.push_back({"analytic, " + std::to_string(count) + " lines a pair", make_analytic({count, 1})});

    double scale = 0;
    for (Index k = 0; k < rows_measured; ++k) {
        const auto patch =
            static_cast<Index>(std::uint64_t{room.mesh.static_size()} * (2 * k + 1) / (2 * rows_measured));
        const FormFactorRow exact = truth->row({room.mesh, room.caster}, patch);
        for (const double f : exact.factor) scale += f * f;
        for (Way& way : ways) {
            FormFactorRow row;
            way.ms.push_back(ms_of([&] { row = way.method->row({room.mesh, room.caster}, patch); }));
            way.square += squared_difference(row, exact);
        }
    }
    for (const Way& way : ways)
        print({{"way", way.name},
               {"patches", room.mesh.size()},
               {"ms_a_row", median(way.ms)},
               {"error", std::sqrt(way.square / scale)}});
}

}  // namespace afterglow
