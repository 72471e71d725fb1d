#include "solver/formfactor/closed_forms.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "solver/base/error.h"

namespace afterglow {
namespace {

using Polygon = std::vector<Vec3d>;

/// A rectangle whose front is on the side of u × v.
Polygon rectangle(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
    return {corner, corner + u, corner + u + v, corner + v};
}

/// A unit square over the origin's corner at height 1, or one centred over it, facing down.
Polygon square_above(double low) {
    return rectangle(Vec3d(low, low, 1), Vec3d(0, 1, 0), Vec3d(1, 0, 0));
}

bool rejects(const std::function<void()>& call, const char* place) {
    try {
        call();
        return false;
    } catch (const Error& error) {
        return error.kind() == ErrorKind::invalid_input && error.place() == place;
    }
}

TEST(ClosedForms, ParallelUnitSquares) {
    EXPECT_NEAR(parallel_rectangles(1, 1, .1), .826994522, 1e-9);
    EXPECT_NEAR(parallel_rectangles(1, 1, .5), .415253284, 1e-9);
    EXPECT_NEAR(parallel_rectangles(1, 1, 1), .199824895698, 1e-12);
    EXPECT_NEAR(parallel_rectangles(1, 1, 2), .068589589, 1e-9);
    EXPECT_NEAR(parallel_rectangles(1, 1, 10), .003162057, 1e-9);
}

TEST(ClosedForms, FarAndNearParallelRectanglesTendToTheirLimits) {
    // Far: A / π d². Near: all light arrives but that lost at the rim, gap × half the perimeter at first
    // order.
    EXPECT_NEAR(parallel_rectangles(2, 3, 1e4) * pi_d * 1e8 / 6, 1, 1e-6);
    EXPECT_NEAR(parallel_rectangles(2, 3, 1e-6), 1 - 5e-6 / 6, 1e-10);
    EXPECT_DOUBLE_EQ(parallel_rectangles(2, 3, 1), parallel_rectangles(3, 2, 1));
}

TEST(ClosedForms, PerpendicularSquaresWithACommonEdge) {
    EXPECT_NEAR(perpendicular_rectangles(1, 1, 1), .200043776075, 1e-12);
    EXPECT_NEAR(perpendicular_rectangles(1, 1, 2), .232852603, 1e-9);
    EXPECT_NEAR(parallel_rectangles(1, 1, 1) + 4 * perpendicular_rectangles(1, 1, 1), 1, 1e-14);
}

TEST(ClosedForms, RowsOfAnyBoxSumToOne) {
    for (const double x : {.3, 1., 7.})
        for (const double y : {.2, 1., 4.})
            for (const double z : {.5, 1., 3.})
                EXPECT_NEAR(parallel_rectangles(x, y, z) + 2 * perpendicular_rectangles(x, y, z) +
                                2 * perpendicular_rectangles(y, x, z),
                            1, 1e-13)
                    << x << " × " << y << " × " << z;
}

TEST(ClosedForms, PointToASquare) {
    EXPECT_NEAR(point_to_polygon({}, square_above(0)), .138531606, 1e-9);
    EXPECT_NEAR(point_to_polygon({}, square_above(-.5)), .239456470, 1e-9);
    // From below the square's corner, looking at right angles to its normal: along one edge.
    EXPECT_NEAR(point_to_polygon({Vec3d(0), Vec3d(1, 0, 0)}, square_above(0)), .055734197, 1e-9);
}

TEST(ClosedForms, PointToWhatIsBehindOrBelowItsHorizonIsZero) {
    Polygon turned = square_above(0);
    std::reverse(turned.begin(), turned.end());
    EXPECT_EQ(point_to_polygon({}, turned), 0);
    EXPECT_EQ(point_to_polygon({Vec3d(0), Vec3d(0, 0, -1)}, square_above(0)), 0);
    EXPECT_EQ(point_to_polygon({Vec3d(.5, .5, 1), Vec3d(0, 0, -1)}, square_above(0)), 0);
    // A wall that goes as far below the horizon as above it counts as its upper half.
    const Polygon whole = rectangle(Vec3d(1, -1, -1), Vec3d(0, 0, 2), Vec3d(0, 2, 0));
    const Polygon half = rectangle(Vec3d(1, -1, 0), Vec3d(0, 0, 1), Vec3d(0, 2, 0));
    EXPECT_NEAR(point_to_polygon({}, whole), point_to_polygon({}, half), 1e-15);
    EXPECT_GT(point_to_polygon({}, half), .1);
}

TEST(ClosedForms, PointToAPolygonThatIsNotConvexIsTheSumOfItsParts) {
    const Polygon l{{0, 0, 1}, {0, 2, 1}, {1, 2, 1}, {1, 1, 1}, {2, 1, 1}, {2, 0, 1}};
    const double parts = point_to_polygon({}, rectangle(Vec3d(0, 0, 1), Vec3d(0, 2, 0), Vec3d(1, 0, 0))) +
                         point_to_polygon({}, rectangle(Vec3d(1, 0, 1), Vec3d(0, 1, 0), Vec3d(1, 0, 0)));
    EXPECT_NEAR(point_to_polygon({}, l), parts, 1e-15);
}

TEST(ClosedForms, PointToADisc) {
    EXPECT_NEAR(point_to_disc(1, 1), .5, 1e-15);
    EXPECT_NEAR(point_to_disc(1, 1) - point_to_disc(.25, .5), .3, 1e-15);
    // Off the axis, against a polygon of many corners; from under the rim of a very large disc half is seen.
    Polygon round;
    for (int k = 0; k < 20000; ++k) {
        const double angle = -2 * pi_d * k / 20000;
        round.emplace_back(std::cos(angle), std::sin(angle), 1);
    }
    for (const double offset : {0., .4, 1., 1.7, 5.})
        EXPECT_NEAR(point_to_disc(1, 1, offset), point_to_polygon({Vec3d(offset, 0, 0)}, round), 1e-8);
    EXPECT_NEAR(point_to_disc(1e6, 1, 1e6), .5, 1e-6);
    EXPECT_NEAR(point_to_disc(1e-9, 1), 1e-18, 1e-30);
}

TEST(ClosedForms, CoaxialDiscs) {
    EXPECT_NEAR(coaxial_discs(1, 1, 1), (3 - std::sqrt(5)) / 2, 1e-15);
    EXPECT_NEAR(9 * coaxial_discs(3, .5, 2), .25 * coaxial_discs(.5, 3, 2), 1e-14);
    EXPECT_NEAR(coaxial_discs(1e-9, 1, 1), point_to_disc(1, 1), 1e-14);
}

TEST(ClosedForms, RejectBadInputAndNameThePlace) {
    EXPECT_TRUE(rejects([] { (void)parallel_rectangles(0, 1, 1); }, "parallel_rectangles"));
    EXPECT_TRUE(rejects([] { (void)perpendicular_rectangles(1, -1, 1); }, "perpendicular_rectangles"));
    EXPECT_TRUE(rejects([] { (void)coaxial_discs(1, 1, std::nan("")); }, "coaxial_discs"));
    EXPECT_TRUE(rejects([] { (void)point_to_disc(1, 1, -1); }, "point_to_disc"));
    EXPECT_TRUE(rejects(
        [] {
            (void)point_to_polygon({}, Polygon{{0, 0, 1}, {1, 0, 1}});
        },
        "point_to_polygon"));
    // No area, not finite, not in one plane.
    EXPECT_TRUE(rejects(
        [] {
            (void)point_to_polygon({}, Polygon{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}});
        },
        "point_to_polygon"));
    EXPECT_TRUE(rejects(
        [] {
            (void)point_to_polygon({}, Polygon{{0, 0, 1}, {1, 0, INFINITY}, {0, 1, 1}});
        },
        "point_to_polygon"));
    EXPECT_TRUE(rejects(
        [] {
            (void)point_to_polygon({}, Polygon{{0, 0, 1}, {1, 0, 1}, {1, 1, 1.5}, {0, 1, 1}});
        },
        "point_to_polygon"));
}

}  // namespace
}  // namespace afterglow
