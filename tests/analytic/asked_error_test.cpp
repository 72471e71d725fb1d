#include "solver/sequence/asked_error.h"

#include <string>

#include <gtest/gtest.h>

#include "solver/image/path.h"
#include "tests/support/picture_error.h"
#include "tests/support/pictures.h"
#include "tests/support/solved_world.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

constexpr int width = 64, height = 48;
// The lamp shines with 1, nothing else is brighter than a fifth of it.
constexpr double lamp_radiance = 0.3;

/// One of two independent halves of a path-traced reference of the small room at its frame 0.
Picture reference_half(std::uint64_t seed, int samples) {
    testing::SolvedWorldConfig config;
    config.lines = 16;
    testing::SolvedWorld room(testing::small_room(), config);
    room.look(0);
    const DirectLight direct(room.mesh, room.lamps, room.caster, room.emission);
    const PathScene scene{&room.world, &room.caster, room.materials,
                          &direct,     room.lights,  room.sight.lift_m()};
    const CameraView view = view_at(room.world.cameras[0], 0, width, height);
    std::uint64_t rays = 0;
    return trace_picture(view, scene, {samples, seed, {}}, rays, Context()).mean;
}

double error_of(const SequenceConfig& config, const Picture& half_a, const Picture& half_b) {
    const Picture picture = testing::pictures_of(testing::small_room(), config).back();
    return test::picture_error(picture, half_a, half_b, lamp_radiance).relative_rmse;
}

SequenceConfig asking(double error) {
    SequenceConfig config;
    config.asked_error = error;
    config.width = width;
    config.height = height;
    config.revisions = Revisions::final_only;
    return config;
}

class AskedErrorPicture : public ::testing::Test {
  protected:
    /// Kept, and not by doing far more than was asked for. The halves' noise must be so small that its
    /// product, over all pixels, is well below the square of the error.
    static void expect_kept(std::initializer_list<double> errors, int samples) {
        const Picture a = reference_half(1, samples), b = reference_half(2, samples);
        for (const double asked : errors) {
            const double actual = error_of(asking(asked), a, b);
            RecordProperty("asked_" + std::to_string(asked), std::to_string(actual));
            EXPECT_LE(actual, asked);
            EXPECT_GE(actual, asked / 3);
        }
    }
};

TEST_F(AskedErrorPicture, IsKept) {
    expect_kept({0.1, 0.05, 0.03}, 256);
}

TEST_F(AskedErrorPicture, SlowSmallOnesAreKept) {
    expect_kept({0.02, 0.01, 0.007}, 2048);
}

TEST_F(AskedErrorPicture, LeavesGivenLinesAndPatchesAlone) {
    SequenceConfig config = asking(0.01);
    config.rays_per_patch = 64;
    config.patch_size_m = 0.5;
    const Picture fine = testing::pictures_of(testing::small_room(), config).back();
    config.asked_error = 0.001;
    const Picture finer = testing::pictures_of(testing::small_room(), config).back();
    // The samples of the pixels are the same, so all the difference is the solution's.
    EXPECT_LT(test::picture_error(fine, finer, finer, lamp_radiance).relative_rmse, 0.01);
}

}  // namespace
}  // namespace afterglow
