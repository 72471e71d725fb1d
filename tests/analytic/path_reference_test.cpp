#include <cmath>
#include <string>

#include <gmock/gmock.h>

#include "solver/image/path.h"
#include "solver/scene/load.h"
#include "tests/support/solved_world.h"

namespace afterglow {
namespace {

const std::string data = AFTERGLOW_TEST_DATA;

/// A frame of a sample scene by our path tracer.
PathPicture trace_frame(const std::string& name, int frame, int samples) {
    const Scene scene = load_scene(data + "/" + name + ".glb");
    testing::SolvedWorldConfig config;
    config.lines = 16;
    testing::SolvedWorld solved(assemble(scene), config);
    const double time_s = frame / solved.world.frames_per_second;
    solved.look(time_s);
    const DirectLight direct(solved.mesh, solved.lamps, solved.caster, solved.emission);
    const PathScene lit{&solved.world, &solved.caster, solved.materials,
                        &direct,       solved.lights,  solved.sight.lift_m()};
    const CameraView view = view_at(solved.world.cameras[0], time_s, 256, 256);
    std::uint64_t rays = 0;
    return trace_picture(view, lit, {samples, 1, {}}, rays, Context());
}

/// Pixels within one pixel of a lamp, as picture_error leaves them out: whether a sample meets the lamp's
/// edge is a matter of a hair.
bool near_lamp(const Picture& a, const Picture& b, int x, int y) {
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, a.height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, a.width - 1); ++u)
            if (std::max(max_channel(a.at(u, v)), max_channel(b.at(u, v))) > 2.5F) return true;
    return false;
}

/// How differences between unbiased estimates, each divided by its standard error, are spread over blocks of
/// 8 × 8 pixels; and that of the whole picture's mean.
struct Scores {
    double mean = 0, spread = 0, largest = 0;  // of the blocks' scores
    int blocks = 0;
    double whole = 0;     // the score of the whole picture
    double relative = 0;  // its difference as a share of its light
};

Scores compare(const PathPicture& ours, const Picture& a, const Picture& b) {
    Scores out;
    double squares = 0, all = 0, all_variance = 0, all_light = 0;
    for (int by = 0; by < a.height; by += 8) {
        for (int bx = 0; bx < a.width; bx += 8) {
            double difference = 0, variance = 0;
            for (int y = by; y < by + 8; ++y) {
                for (int x = bx; x < bx + 8; ++x) {
                    if (near_lamp(a, b, x, y)) continue;
                    // The channels are hardly independent; one number a pixel is enough.
                    const auto grey = [&](const Picture& p) {
                        return glm::dot(glm::dvec3(p.at(x, y)), glm::dvec3(1 / 3.0));
                    };
                    difference += grey(ours.mean) - 0.5 * (grey(a) + grey(b));
                    all_light += 0.5 * (grey(a) + grey(b));
                    // The standard deviation of fully correlated channels adds up.
                    const glm::dvec3 v(ours.variance.at(x, y));
                    const double deviation = (std::sqrt(v.x) + std::sqrt(v.y) + std::sqrt(v.z)) / 3;
                    variance += deviation * deviation + 0.25 * std::pow(grey(a) - grey(b), 2);
                }
            }
            if (variance <= 0) continue;
            const double score = difference / std::sqrt(variance);
            out.mean += score;
            squares += score * score;
            out.largest = std::max(out.largest, std::abs(score));
            all += difference;
            all_variance += variance;
            ++out.blocks;
        }
    }
    out.mean /= out.blocks;
    out.spread = std::sqrt(squares / out.blocks);
    out.whole = all / std::sqrt(all_variance);
    out.relative = all / all_light;
    return out;
}

class PathReference : public ::testing::Test {
  protected:
    static void expect_standard_normal(const std::string& name, int frame, int samples) {
        const PathPicture ours = trace_frame(name, frame, samples);
        const std::string stem = data + "/reference/" + name + "_" + std::to_string(10000 + frame).substr(1);
        const Scores scores = compare(ours, read_picture(stem + "_1.exr"), read_picture(stem + "_2.exr"));
        RecordProperty(name + "_mean", std::to_string(scores.mean));
        RecordProperty(name + "_spread", std::to_string(scores.spread));
        RecordProperty(name + "_relative_difference", std::to_string(scores.relative));

        EXPECT_LT(std::abs(scores.whole), 3) << "standard errors of the picture's mean";
        EXPECT_LT(std::abs(scores.relative / scores.whole), 0.002) << "a bias of 0.6 % would be seen";
        // A thousand blocks: the mean's standard error is 0.03, the spread's 0.022 and more for the long
        // tails that path tracing has. Those also make a sample's mean and spread rise together, so scores
        // lean low by skewness / (2 √n): about 0.1 for a skewness of 6 over 1,024 paths.
        ASSERT_GT(scores.blocks, 900);
        EXPECT_LT(std::abs(scores.mean), 0.1 + 0.1);
        EXPECT_NEAR(scores.spread, 1, 0.1);
        EXPECT_LT(scores.largest, 6);
    }
};

TEST_F(PathReference, CornellSlide) {
    expect_standard_normal("cornell-slide", 12, 16);
}

TEST_F(PathReference, LivingRoom) {
    expect_standard_normal("living-room", 24, 16);
}

TEST_F(PathReference, SlowOtherFrames) {
    for (const int frame : {0, 36}) expect_standard_normal("cornell-slide", frame, 32);
    for (const int frame : {0, 72}) expect_standard_normal("living-room", frame, 32);
}

}  // namespace
}  // namespace afterglow
