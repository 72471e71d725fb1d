#include "solver/visibility/hidden_frames.h"

#include <random>

#include <gmock/gmock.h>

namespace afterglow {
namespace {

RayPacket ray_of_length(float far_m) {
    RayPacket rays;
    rays.count = 1;
    rays.far.fill(far_m);
    return rays;
}

using Changes = std::vector<std::pair<int, bool>>;
Changes changes_of(const HiddenFrames& hidden, std::size_t lane) {
    Changes out;
    hidden.for_changes(lane, [&](int frame, bool blocked) { out.emplace_back(frame, blocked); });
    return out;
}

TEST(HiddenFrames, AreWhatATimeBufferHasAFaceIn) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> depth(-1, 3), step(-0.1F, 0.1F);
    HiddenFrames hidden(200);
    TimeBuffer buffer(200);
    for (int trial = 0; trial < 500; ++trial) {
        const RayPacket rays = ray_of_length(2);
        hidden.clear(rays);
        buffer.clear(rays);
        const std::size_t lane = static_cast<std::size_t>(trial) % 16;
        for (int put = 0; put < trial % 5; ++put) {
            const int first = std::uniform_int_distribution(0, 199)(random),
                      last = std::uniform_int_distribution(first, 199)(random);
            const float at = depth(random);
            const FaceRun run{0, first, last, at, step(random), at - 0.2F, at + 0.2F, step(random)};
            hidden.put(lane, run);
            buffer.put(lane, run);
        }
        bool now = false;
        Changes expected;
        for (int f = 0; f < 200; ++f) {
            const bool open = buffer.first(lane) <= f && f <= buffer.last(lane);
            const bool blocked = open && buffer.faces(lane)[static_cast<std::size_t>(f)] != no_index;
            if (blocked != now) expected.emplace_back(f, blocked);
            now = blocked;
        }
        EXPECT_EQ(changes_of(hidden, lane), expected) << trial;
        EXPECT_TRUE(hidden.any(lane) || expected.empty());
    }
}

TEST(HiddenFrames, EndWithTheLastFrame) {
    for (const int frames : {1, 63, 64, 65, 128}) {
        HiddenFrames hidden(frames);
        hidden.clear(ray_of_length(2));
        hidden.put(0, {0, 0, frames - 1, 1, 0, 1, 1, 0});
        EXPECT_EQ(changes_of(hidden, 0), (Changes{{0, true}})) << frames;
        EXPECT_TRUE(changes_of(hidden, 1).empty());
    }
}

}  // namespace
}  // namespace afterglow
