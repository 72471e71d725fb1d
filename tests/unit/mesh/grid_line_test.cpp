#include "solver/mesh/grid_line.h"

#include <gmock/gmock.h>

namespace afterglow {
namespace {

TEST(GridLine, DistancesAreInMetresWhateverTheCells) {
    const GridLine line = line_through(Vec2(0, 0), Vec2(4, 3), Vec2(0.75F, 1));  // 3 × 3 m: a diagonal
    EXPECT_NEAR(std::abs(line.distance(Vec2(4, 0))), 3 / std::sqrt(2.0F), 1e-6);
    EXPECT_NEAR(line.distance(Vec2(4, 0)), -line.distance(Vec2(0, 3)), 1e-6);
    EXPECT_NEAR(line.distance(Vec2(8, 6)), 0, 1e-6);
}

TEST(GridLine, ASegmentIsClippedToARectangle) {
    const GridSegment segment{Vec2(-1, 0), Vec2(3, 2)};
    const auto part = clip(segment, Vec2(0), Vec2(1));
    ASSERT_TRUE(part.has_value());
    EXPECT_NEAR(glm::length(part->from - Vec2(0, 0.5F)), 0, 1e-6);
    EXPECT_NEAR(glm::length(part->to - Vec2(1, 1)), 0, 1e-6);
    EXPECT_FALSE(clip(segment, Vec2(2, 0), Vec2(3, 1)).has_value());
    EXPECT_FALSE(clip({Vec2(2, 0), Vec2(2, 1)}, Vec2(0), Vec2(1)).has_value());
}

TEST(GridLine, WaysCrossASegmentAndNotItsLine) {
    const GridSegment segment{Vec2(1, 0), Vec2(1, 2)};
    EXPECT_TRUE(crosses(segment, Vec2(0, 1), Vec2(2, 1)));
    EXPECT_FALSE(crosses(segment, Vec2(0, 3), Vec2(2, 3)));
    EXPECT_FALSE(crosses(segment, Vec2(0, 1), Vec2(0.9F, 1)));
    EXPECT_TRUE(crosses(segment, Vec2(1, 1), Vec2(2, 1))) << "a way that begins on it is on neither side";
    EXPECT_FALSE(crosses(segment, Vec2(1, 3), Vec2(2, 3)));
}

}  // namespace
}  // namespace afterglow
