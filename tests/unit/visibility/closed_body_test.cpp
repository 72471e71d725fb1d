#include "solver/visibility/closed_body.h"

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::add_box;
using testing::Facing;

TEST(ClosedBody, BoxesAndBallsAre) {
    Body body;
    add_box(body, Vec3(-1), Vec3(1), 0);
    EXPECT_TRUE(is_closed_outwards(body));
    add_box(body, Vec3(0), Vec3(5), 0);  // one that reaches into the other
    testing::add_ball(body, Vec3(100, 0, 0), 1, 2, 0);
    EXPECT_TRUE(is_closed_outwards(body));
}

TEST(ClosedBody, OneWithAHoleIsNot) {
    Body body;
    add_box(body, Vec3(-1), Vec3(1), 0);
    body.triangles.pop_back();
    EXPECT_FALSE(is_closed_outwards(body));
}

TEST(ClosedBody, OneTurnedInsideOutIsNot) {
    Body body;
    add_box(body, Vec3(0), Vec3(10), 0);
    add_box(body, Vec3(20), Vec3(21), 0, Facing::inwards);
    EXPECT_FALSE(is_closed_outwards(body));
}

TEST(ClosedBody, OneWithAFaceTurnedIsNot) {
    Body body;
    add_box(body, Vec3(0), Vec3(1), 0);
    std::swap(body.triangles[3].vertices[0], body.triangles[3].vertices[1]);
    EXPECT_FALSE(is_closed_outwards(body));
}

TEST(ClosedBody, SheetsAndNothingAreNot) {
    Body body;
    EXPECT_FALSE(is_closed_outwards(body));
    testing::add_quad(body, Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0), 0);
    EXPECT_FALSE(is_closed_outwards(body));
    testing::add_quad(body, Vec3(0), Vec3(0, 1, 0), Vec3(1, 0, 0), 0);  // its other side: no volume
    EXPECT_FALSE(is_closed_outwards(body));
}

}  // namespace
}  // namespace afterglow
