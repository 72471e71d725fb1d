// What bringing a picture to the next frame costs beside making it from nothing, on the living room, frame
// by frame, both in one run. Prints one table. Usage: kept_picture [frames] [width] [height] [threads]

#include "solver/image/kept_picture.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

#include "solver/scene/load.h"
#include "tests/bench/timing.h"
#include "tests/support/solved_world.h"

namespace afterglow {
namespace {

constexpr int first_frame = 12;
constexpr double frames_per_second = 24;

/// The light of one frame that pictures interpolate.
struct FrameLight {
    std::vector<Rgb> indirect;
    std::vector<float> confidence;
};

FrameLight light_at_frame(testing::SolvedWorld& room, int frame) {
    room.solve(frame / frames_per_second);
    FrameLight out{room.solution.state.irradiance, room.factors.valid_share};
    const FormFactorMatrix& matrix = room.factors.matrix;
    for (std::size_t i = 0; i < matrix.rows(); ++i) {
        out.indirect[i] -= room.from_lights[i];
        for (std::uint64_t k = matrix.row_begin[i]; k < matrix.row_begin[i + 1]; ++k)
            if (room.lamps.lamp_of_patch[matrix.column[k]] != no_index)
                out.indirect[i] -= matrix.value[k] * room.emission[matrix.column[k]];
        out.indirect[i] = glm::max(out.indirect[i], Rgb(0));
    }
    return out;
}

struct Level {
    const char* name;
    KeptPictureConfig config;
    bool light_rests = false;  ///< that of the first frame for all
};

struct Costs {
    std::vector<double> fresh_ms, kept_ms, samples, fresh_rays, kept_rays;
    double anew_ms = 0;
    std::size_t all_samples = 0, bytes = 0;
};

class Bench {
  public:
    Bench(int frames, int width, int height, int threads)
        : width_(width),
          height_(height),
          context_(threads),
          room_(assemble(load_scene(AFTERGLOW_TEST_DATA "/living-room.glb")),
                {.patch_size_m = 0.15F,
                 .lines = 256,
                 .visibility = Visibility::back_buffer,
                 .asked_error = 0.005}),
          interpolation_(room_.world, room_.mesh),
          normals_(room_.world, room_.mesh.surfaces) {
        for (int f = 0; f < frames; ++f) light_.push_back(light_at_frame(room_, first_frame + f));
    }

    Costs run(const Level& level) {
        Costs costs;
        KeptPictureState state;
        for (std::size_t f = 0; f < light_.size(); ++f) {
            const double time_s = (first_frame + static_cast<int>(f)) / frames_per_second;
            room_.caster.set_poses(poses_at(room_.world, time_s));
            const DirectLight direct(room_.mesh, room_.lamps, room_.caster, room_.emission);
            const LitWorld lit = lit_by(light_[level.light_rests ? 0 : f], direct);
            const CameraView view = view_at(room_.world.cameras.front(), time_s, width_, height_);
            std::uint64_t rays = 0;
            costs.fresh_ms.push_back(
                ms_of([&] { render_picture(view, lit, level.config.picture, rays, context_); }));
            costs.fresh_rays.push_back(static_cast<double>(rays));
            PictureUpdate update;
            const double ms = ms_of([&] { update = step(state, view, lit, level.config, context_); });
            if (update.anew) {
                costs.anew_ms = ms;
                continue;
            }
            costs.kept_ms.push_back(ms);
            costs.samples.push_back(static_cast<double>(update.samples));
            costs.kept_rays.push_back(static_cast<double>(update.rays_traced));
        }
        for (const KeptTile& tile : state.tiles) {
            costs.all_samples += tile.first.size() + tile.further.size();
            costs.bytes += tile.bytes();
        }
        return costs;
    }
    [[nodiscard]] Index patches() const { return room_.mesh.size(); }

  private:
    [[nodiscard]] LitWorld lit_by(const FrameLight& light, const DirectLight& direct) const {
        LitWorld lit;
        lit.world = &room_.world;
        lit.mesh = &room_.mesh;
        lit.interpolation = &interpolation_;
        lit.normals = &normals_;
        lit.caster = &room_.caster;
        lit.materials = room_.materials;
        lit.irradiance = light.indirect;
        lit.confidence = light.confidence;
        lit.direct = &direct;
        lit.lights = room_.lights;
        lit.lift_m = room_.sight.lift_m();
        return lit;
    }

    int width_, height_;
    Context context_;
    testing::SolvedWorld room_;
    Interpolation interpolation_;
    SmoothNormals normals_;
    std::vector<FrameLight> light_;
};

int run(int argc, char** argv) {
    const auto argument = [&](int k, int otherwise) { return argc > k ? std::atoi(argv[k]) : otherwise; };
    const int width = argument(2, 320), height = argument(3, 180);
    Bench bench(argument(1, 24), width, height, argument(4, 1));
    const PictureConfig preview{4, 16, 2, 0.05F}, final{8, 64, 4, 0.02F};
    const std::vector<Level> levels{{"preview, light rests", {preview}, true},
                                    {"preview", {preview, 0.0025F}},
                                    {"preview, exact", {preview}},
                                    {"final, light rests", {final}, true},
                                    {"final", {final, 0.001F}},
                                    {"final, exact", {final}}};
    std::printf("%d x %d pixels, %u patches; medians of frames, CPU ms\n", width, height, bench.patches());
    std::printf("%-22s %8s %8s %8s %6s %12s %12s %12s %12s %6s\n", "", "fresh", "anew", "kept", "ratio",
                "samples", "again", "rays fresh", "rays kept", "bytes");
    for (const Level& level : levels) {
        const Costs costs = bench.run(level);
        const double fresh = median(costs.fresh_ms), kept = median(costs.kept_ms);
        std::printf("%-22s %8.1f %8.1f %8.1f %6.1f %12zu %12.0f %12.0f %12.0f %6.0f\n", level.name, fresh,
                    costs.anew_ms, kept, fresh / kept, costs.all_samples, median(costs.samples),
                    median(costs.fresh_rays), median(costs.kept_rays),
                    static_cast<double>(costs.bytes) / static_cast<double>(costs.all_samples));
    }
    return 0;
}

}  // namespace
}  // namespace afterglow

int main(int argc, char** argv) {
    return afterglow::run(argc, argv);
}
