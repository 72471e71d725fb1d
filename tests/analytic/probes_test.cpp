#include "solver/image/probes.h"

#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "solver/scene/load.h"
#include "solver/sequence/sequence.h"
#include "tests/support/picture_error.h"

namespace afterglow {
namespace {

const std::string data = AFTERGLOW_TEST_DATA;

/// Renders a frame of a sample scene with an estimate of its error, measures the error, and returns the one
/// over the other.
double estimated_over_actual(const std::string& name, int frame, Quality quality, std::uint64_t seed) {
    SequenceConfig config;
    config.seed = seed;
    config.quality = quality;
    config.width = config.height = 256;
    config.revisions = Revisions::final_only;
    config.estimate = Estimate::probes;
    Picture picture;
    const auto frames =
        render_sequence(assemble(load_scene(data + "/" + name + ".glb")), config, frame, frame,
                        [&](const Revision& revision) { picture = revision.radiance; });
    const std::string stem = data + "/reference/" + name + "_" + std::to_string(10000 + frame).substr(1);
    const double actual =
        test::picture_error(picture, read_picture(stem + "_1.exr"), read_picture(stem + "_2.exr"))
            .relative_rmse;
    const double estimate = frames.front().picture_error.value();
    const double up = estimate + frames.front().picture_error_spread.value();
    EXPECT_LT(up, 2 * actual + estimate) << "the spread is of the error's size at most";
    const std::string title = name + "_" + std::to_string(frame) + "_" +
                              std::to_string(static_cast<int>(quality)) + "_" + std::to_string(seed);
    ::testing::Test::RecordProperty(title + "_measured", std::to_string(actual));
    ::testing::Test::RecordProperty(title + "_estimated", std::to_string(estimate));
    return estimate / actual;
}

/// Few pixels make most of an error, so a single draw of them may miss it; over some draws none should.
void expect_honest_estimate(const std::string& name, int frame, Quality quality) {
    constexpr std::uint64_t seeds = 3;
    double product = 1;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const double ratio = estimated_over_actual(name, frame, quality, seed);
        EXPECT_GT(ratio, 1 / 3.0) << name << " frame " << frame << " seed " << seed;
        EXPECT_LT(ratio, 3.0) << name << " frame " << frame << " seed " << seed;
        product *= ratio;
    }
    const double mean = std::pow(product, 1.0 / seeds);
    EXPECT_GT(mean, 1 / 1.5) << name << " frame " << frame;
    EXPECT_LT(mean, 1.5) << name << " frame " << frame;
}

TEST(ProbesReference, PreviewIsHonest) {
    expect_honest_estimate("cornell-slide", 12, Quality::preview);
    expect_honest_estimate("living-room", 24, Quality::preview);
}

TEST(ProbesReference, SlowAllFramesAreHonest) {
    for (const Quality quality : {Quality::preview, Quality::final}) {
        for (const int frame : {0, 12, 36}) expect_honest_estimate("cornell-slide", frame, quality);
        for (const int frame : {0, 24, 72}) expect_honest_estimate("living-room", frame, quality);
    }
}

}  // namespace
}  // namespace afterglow
