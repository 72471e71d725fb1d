#include "solver/sequence/sketch.h"

#include <cmath>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "tests/unit/sequence/quick_sequences.h"

namespace afterglow {
namespace {

using testing::final_of;
using testing::quick;
using testing::same_bits;
using testing::small_room;

double mean_of(const Picture& picture) {
    double sum = 0;
    for (const Rgb& pixel : picture.pixels) sum += static_cast<double>(pixel.r + pixel.g + pixel.b);
    return sum / static_cast<double>(picture.pixels.size());
}

TEST(Sketch, ShowsTheFrameRoughly) {
    const SequenceConfig config = quick();
    SequenceState state = make_sketch_state(small_room(), config, Context(2));
    for (const int frame : {2, 0}) {
        const Revision rough = sketch(state, frame, Context(2));
        const Picture finished = final_of(small_room(), config, frame);
        EXPECT_EQ(rough.frame, frame);
        EXPECT_EQ(rough.revision, 1);
        EXPECT_FALSE(rough.final);
        ASSERT_EQ(rough.radiance.width, config.width);
        ASSERT_EQ(rough.radiance.height, config.height);
        EXPECT_EQ(rough.srgb.size(), 3 * finished.pixels.size());
        EXPECT_NEAR(mean_of(rough.radiance) / mean_of(finished), 1, 0.3);
    }
}

TEST(Sketch, IsMadeFromFewPatchesWhateverIsAskedFor) {
    SequenceConfig config = quick();
    config.patch_size_m = 0.05;
    config.quality = Quality::final;
    const SequenceState fine = make_state(small_room(), config, Context(2));
    const SequenceState rough = make_sketch_state(small_room(), config, Context(2));
    EXPECT_LT(rough.statistics().sight_lines, fine.statistics().sight_lines / 10);
}

TEST(Sketch, IsTheSameEveryTimeForAnyNumberOfThreads) {
    SequenceState a = make_sketch_state(small_room(), quick(), Context(1));
    SequenceState b = make_sketch_state(small_room(), quick(), Context(4));
    const Revision first = sketch(a, 1, Context(1));
    EXPECT_TRUE(same_bits(first.radiance, sketch(b, 1, Context(4)).radiance));
    EXPECT_TRUE(same_bits(first.radiance, sketch(a, 1, Context(2)).radiance));
}

TEST(Sketch, TakesTheExposureThatIsAskedFor) {
    SequenceConfig config = quick();
    config.exposure_ev = -40;
    SequenceState state = make_sketch_state(small_room(), config, Context(2));
    EXPECT_THAT(sketch(state, 0, Context(2)).srgb, ::testing::Each(0));
}

TEST(Sketch, RefusesWhatASequenceRefuses) {
    SequenceConfig config = quick();
    config.camera = "nobody's";
    EXPECT_THROW(make_sketch_state(small_room(), config, Context(1)), Error);
    SequenceState state = make_sketch_state(small_room(), quick(), Context(1));
    EXPECT_THROW(sketch(state, -1, Context(1)), Error);
}

}  // namespace
}  // namespace afterglow
