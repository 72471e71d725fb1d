#include "solver/formfactor/polygon_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "solver/formfactor/closed_forms.h"
#include "solver/formfactor/edge_pair.h"

namespace afterglow {
namespace {

using Polygon = std::vector<Vec3d>;

Polygon rectangle(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
    return {corner, corner + u, corner + u + v, corner + v};
}
const Polygon floor_square = rectangle(Vec3d(0), Vec3d(1, 0, 0), Vec3d(0, 1, 0));
Polygon ceiling_square(double gap) {
    return rectangle(Vec3d(0, 0, gap), Vec3d(0, 1, 0), Vec3d(1, 0, 0));
}
Polygon wall(double height) {
    return rectangle(Vec3d(0), Vec3d(0, 1, 0), Vec3d(0, 0, height));
}

/// Ten Gauss–Legendre nodes and weights on [0, 1], by Newton's method on the Legendre polynomial.
struct GaussRule {
    std::array<double, 10> node{}, weight{};

    GaussRule() {
        for (std::size_t k = 0; k < 10; ++k) {
            double x = std::cos(pi_d * (static_cast<double>(k) + .75) / 10.5), slope = 1;
            for (int step = 0; step < 20; ++step) {
                double before = 1, value = x;
                for (int n = 2; n <= 10; ++n)
                    before = std::exchange(value, ((2 * n - 1) * x * value - (n - 1) * before) / n);
                slope = 10 * (x * value - before) / (x * x - 1);
                x -= value / slope;
            }
            node[k] = (x + 1) / 2;
            weight[k] = 1 / ((1 - x * x) * slope * slope);
        }
    }
};

/// The oracle: point to polygon exactly, integrated over the first polygon by triangles that are quartered
/// until that changes nothing.
class Oracle {
  public:
    Oracle(const Polygon& from, const Polygon& to, double tolerance) : to_(to), tolerance_(tolerance) {
        const Plane plane = plane_of(from);
        normal_ = plane.normal;
        clip_to_front(from, plane_of(to), 0, from_);
        area_ = glm::length(area_vector(from));
    }

    [[nodiscard]] double value() const {
        double sum = 0;
        for (std::size_t k = 2; k < from_.size(); ++k) {
            const std::array corners{from_[0], from_[k - 1], from_[k]};
            sum += refined(corners, once(corners), 9);
        }
        return sum / area_;
    }

  private:
    [[nodiscard]] double once(const std::array<Vec3d, 3>& t) const {
        const GaussRule& rule = rule_;
        double sum = 0;
        for (std::size_t i = 0; i < 10; ++i)
            for (std::size_t j = 0; j < 10; ++j) {
                const double u = rule.node[i], v = u * rule.node[j];
                const Vec3d x = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[1]);
                sum += rule.weight[i] * rule.weight[j] * u * point_to_polygon({x, normal_}, to_);
            }
        return sum * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
    }
    [[nodiscard]] double refined(const std::array<Vec3d, 3>& t, double whole, int levels) const {
        const Vec3d a = 0.5 * (t[0] + t[1]), b = 0.5 * (t[1] + t[2]), c = 0.5 * (t[2] + t[0]);
        const std::array<std::array<Vec3d, 3>, 4> parts{
            {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}}};
        std::array<double, 4> values{};
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += values[k] = once(parts[k]);
        if (levels == 0 || std::abs(sum - whole) < tolerance_ * area_) return sum;
        sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += refined(parts[k], values[k], levels - 1);
        return sum;
    }

    GaussRule rule_;
    Polygon from_, to_;
    Vec3d normal_{0};
    double area_ = 0, tolerance_;
};

class Random {
  public:
    explicit Random(std::uint32_t seed) : generator_(seed) {}
    double unit() { return uniform_(generator_); }
    Vec3d direction() {
        const double z = 2 * unit() - 1, angle = 2 * pi_d * unit(), r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }
    /// A convex polygon within a circle of radius 1 around `centre`, somehow turned.
    Polygon polygon(const Vec3d& centre) {
        const std::size_t corners = 3 + static_cast<std::size_t>(6 * unit());
        const Vec3d normal = direction(), u = glm::normalize(glm::cross(normal, direction()));
        const Vec3d v = glm::cross(normal, u);
        std::vector<double> angles;
        for (std::size_t k = 0; k < corners; ++k)
            angles.push_back(2 * pi_d * (static_cast<double>(k) + .8 * unit()) /
                             static_cast<double>(corners));
        Polygon out;
        for (const double angle : angles) out.push_back(centre + std::cos(angle) * u + std::sin(angle) * v);
        return out;
    }

  private:
    std::mt19937 generator_;
    std::uniform_real_distribution<double> uniform_{0, 1};
};

Polygon moved(const Polygon& polygon, const glm::dquat& turn, const Vec3d& shift) {
    Polygon out;
    for (const Vec3d& c : polygon) out.push_back(turn * c + shift);
    return out;
}

TEST(PolygonPair, ParallelUnitSquares) {
    for (const double gap : {.001, .1, .5, 1., 2., 10.})
        EXPECT_NEAR(polygon_form_factor(floor_square, ceiling_square(gap)), parallel_rectangles(1, 1, gap),
                    1e-12)
            << gap;
    EXPECT_NEAR(polygon_form_factor(floor_square, ceiling_square(1)), .199824895698, 1e-12);
}

TEST(PolygonPair, TouchingSquaresHaveTheirExactValue) {
    for (const double height : {.01, 1., 2., 50.})
        EXPECT_NEAR(polygon_form_factor(floor_square, wall(height)), perpendicular_rectangles(1, 1, height),
                    1e-12)
            << height;
    EXPECT_NEAR(polygon_form_factor(floor_square, wall(1)), .200043776075, 1e-12);
    EXPECT_NEAR(polygon_form_factor(floor_square, wall(2)), .232852603, 1e-9);
}

TEST(PolygonPair, PointToPointFailsWhereTheClosedFormDoesNot) {
    // Between centres, touching squares: cos θ cos θ′ A / π r² = ½ / (π ½).
    const auto between_centres = [](const Polygon& a, const Polygon& b) {
        const Plane pa = plane_of(a), pb = plane_of(b);
        const Vec3d ca = 0.25 * (a[0] + a[1] + a[2] + a[3]), cb = 0.25 * (b[0] + b[1] + b[2] + b[3]);
        const double rr = glm::dot(cb - ca, cb - ca);
        return pa.height(cb) * pb.height(ca) * glm::length(area_vector(b)) / (pi_d * rr * rr);
    };
    EXPECT_NEAR(between_centres(floor_square, wall(1)), .318, 5e-4);
    EXPECT_NEAR(polygon_form_factor(floor_square, wall(1)), .2000, 5e-5);
    EXPECT_GT(between_centres(floor_square, ceiling_square(.1)), 1);
    EXPECT_NEAR(polygon_form_factor(floor_square, ceiling_square(.1)), .8270, 5e-5);
}

TEST(PolygonPair, AgreesWithQuadratureForRandomPairs) {
    Random random(1);
    int in_view = 0;
    for (int k = 0; k < 200; ++k) {
        const Polygon a = random.polygon(Vec3d(0));
        const Polygon b = random.polygon((2.02 + 2 * random.unit() * random.unit()) * random.direction());
        const double expected = Oracle(a, b, 1e-10).value();
        ASSERT_NEAR(polygon_form_factor(a, b), expected, 1e-9) << "pair " << k;
        if (expected > 1e-4) ++in_view;
    }
    EXPECT_GT(in_view, 60);
}

TEST(PolygonPair, AgreesWithQuadratureWhereOnePlaneCutsTheOtherPolygon) {
    // A wall that goes through the floor's plane beside it; only what is in front counts, from both.
    const Polygon through = rectangle(Vec3d(-.2, -.3, -1), Vec3d(.1, 1.5, .2), Vec3d(-.3, .2, 2.5));
    const double expected = Oracle(floor_square, through, 1e-11).value();
    EXPECT_GT(expected, .05);
    EXPECT_NEAR(polygon_form_factor(floor_square, through), expected, 1e-9);
}

TEST(PolygonPair, FacesOfRandomTetrahedraTouchAndSumToOne) {
    Random random(2);
    double worst = 0;
    for (int k = 0; k < 300; ++k) {
        std::array<Vec3d, 4> v{};
        for (Vec3d& corner : v) corner = (.3 + random.unit()) * random.direction();
        if (glm::dot(v[3] - v[0], glm::cross(v[1] - v[0], v[2] - v[0])) < 0) std::swap(v[0], v[1]);
        const std::array<Polygon, 4> faces{Polygon{v[0], v[1], v[2]}, Polygon{v[0], v[3], v[1]},
                                           Polygon{v[1], v[3], v[2]}, Polygon{v[2], v[3], v[0]}};
        for (const Polygon& face : faces) {
            double sum = 0;
            for (const Polygon& other : faces)
                if (&other != &face) sum += polygon_form_factor(face, other);
            const double area = glm::length(area_vector(face));
            // Thin faces lose digits to cancellation: an error of the exchange area, not of the share.
            worst = std::max(worst, std::abs(sum - 1) * std::min(area, 1.));
        }
    }
    EXPECT_LT(worst, 1e-11);
}

TEST(PolygonPair, TurningAndMovingChangesNothing) {
    Random random(3);
    for (int k = 0; k < 100; ++k) {
        const glm::dquat turn = glm::angleAxis(2 * pi_d * random.unit(), random.direction());
        const Vec3d shift = 10 * random.unit() * random.direction();
        EXPECT_NEAR(polygon_form_factor(moved(floor_square, turn, shift), moved(wall(1), turn, shift)),
                    perpendicular_rectangles(1, 1, 1), 1e-13);
        EXPECT_NEAR(
            polygon_form_factor(moved(floor_square, turn, shift), moved(ceiling_square(.1), turn, shift)),
            parallel_rectangles(1, 1, .1), 1e-12);
    }
}

TEST(PolygonPair, NearlyParallelEdgesAreAsGoodAsParallelOnes) {
    // A sheared wall; the change must be as smooth in the angle as it is: no jump where the method changes.
    const double straight = perpendicular_rectangles(1, 1, 1);
    const auto sheared = [&](double slope) {
        const Polygon lifted = rectangle(Vec3d(0), Vec3d(0, 1, slope), Vec3d(0, 0, 1));
        return (polygon_form_factor(floor_square, lifted) - straight) / slope;
    };
    const double reference = sheared(1e-6);
    for (const double slope : {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3, 3e-3})
        EXPECT_NEAR(sheared(slope), reference, 1e-12 / slope + slope + 2e-6) << slope;
}

TEST(PolygonPair, RoundedCornersDoLittleHarm) {
    // Each face of a turned box with its own roundings, as single-precision scenes have them: edges that were
    // shared are a ten-millionth apart, cross, or have gaps.
    Random random(6);
    const Vec3d x(1, 0, 0), y(0, 1.5, 0), z(0, 0, .7);
    const std::array<Polygon, 6> box{rectangle(Vec3d(0), x, y), rectangle(z, y, x),
                                     rectangle(Vec3d(0), y, z), rectangle(x, z, y),
                                     rectangle(Vec3d(0), z, x), rectangle(y, x, z)};
    for (int k = 0; k < 20; ++k) {
        const glm::dquat turn = glm::angleAxis(2 * pi_d * random.unit(), random.direction());
        std::vector<Polygon> faces;
        for (const Polygon& face : box) {
            faces.push_back(moved(face, turn, Vec3d(2, -1, 3)));
            for (Vec3d& c : faces.back()) c += 1e-7 * random.direction();
        }
        for (const Polygon& face : faces) {
            double sum = 0;
            for (const Polygon& other : faces)
                if (&other != &face) sum += polygon_form_factor(face, other);
            EXPECT_NEAR(sum, 1, 3e-6) << k;
        }
    }
}

TEST(PolygonPair, PartsAddUpToTheWhole) {
    Random random(4);
    for (int k = 0; k < 50; ++k) {
        const Polygon a = random.polygon(Vec3d(0)), b = random.polygon(1.5 * random.direction());
        const Polygon first(a.begin(), a.begin() + 3);
        Polygon rest(a.begin() + 2, a.end());
        rest.push_back(a[0]);
        double sum = polygon_exchange_area(first, b);
        if (a.size() > 3) sum += polygon_exchange_area(rest, b);
        EXPECT_NEAR(polygon_exchange_area(a, b), sum, 1e-11) << k;
    }
}

TEST(PolygonPair, APolygonThatIsNotConvexIsTheSumOfItsParts) {
    const Polygon l{{0, 0, 1}, {0, 2, 1}, {1, 2, 1}, {1, 1, 1}, {2, 1, 1}, {2, 0, 1}};
    const Polygon across = rectangle(Vec3d(0, -1, 0), Vec3d(2, 0, 0), Vec3d(0, 4, 2.5));
    const Polygon long_part = rectangle(Vec3d(0, 0, 1), Vec3d(0, 2, 0), Vec3d(1, 0, 0));
    const Polygon short_part = rectangle(Vec3d(1, 0, 1), Vec3d(0, 1, 0), Vec3d(1, 0, 0));
    EXPECT_GT(polygon_exchange_area(l, across), .1);
    EXPECT_NEAR(polygon_exchange_area(l, across),
                polygon_exchange_area(long_part, across) + polygon_exchange_area(short_part, across), 1e-12);
}

TEST(PolygonPair, IsReciprocal) {
    Random random(5);
    for (int k = 0; k < 100; ++k) {
        const Polygon a = random.polygon(Vec3d(0)), b = random.polygon(2.5 * random.direction());
        const double there = glm::length(area_vector(a)) * polygon_form_factor(a, b);
        const double back = glm::length(area_vector(b)) * polygon_form_factor(b, a);
        EXPECT_NEAR(there, back, 1e-12);
    }
}

TEST(PolygonPair, WhatCannotSeeEachOtherExchangesNothing) {
    Polygon turned = ceiling_square(1);
    std::reverse(turned.begin(), turned.end());
    EXPECT_EQ(polygon_form_factor(floor_square, turned), 0);
    // In one plane, apart and with a shared edge; below the floor.
    for (const double x : {1., 3.}) {
        const Polygon beside = rectangle(Vec3d(x, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0));
        EXPECT_EQ(polygon_form_factor(floor_square, beside), 0);
    }
    EXPECT_EQ(polygon_form_factor(floor_square, ceiling_square(-1)), 0);
}

TEST(PolygonPair, FarPolygonsKeepTheirDigits) {
    for (const double gap : {100., 1000.})
        EXPECT_NEAR(polygon_form_factor(floor_square, ceiling_square(gap)) / parallel_rectangles(1, 1, gap),
                    1, 1e-9)
            << gap;
}

TEST(PolygonPair, RejectsPolygonsWithoutArea) {
    const Polygon thin{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
    try {
        (void)polygon_form_factor(floor_square, thin);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        EXPECT_EQ(error.place(), "polygon_form_factor, second polygon");
    }
    EXPECT_THROW((void)polygon_form_factor(thin, floor_square), Error);
}

TEST(EdgePair, AllCasesMeetWhereTheyChange) {
    // One edge turned about a corner shared with the other, and about one a little above it, from parallel to
    // beyond a right angle: values by plain quadrature, refined towards the corner.
    const GaussRule rule;
    for (const double lift : {0., 1e-3, .2})
        for (const double angle : {1e-8, 1e-5, 1e-3, .02, .3, 1.5, 3.1}) {
            const ContourEdge a{Vec3d(0), Vec3d(1, 0, 0)};
            const ContourEdge b{Vec3d(0, 0, lift), Vec3d(std::cos(angle), std::sin(angle), lift)};
            double coarse = contour_integral(a, b, 1e-6), fine = contour_integral(a, b, 1e-13);
            EXPECT_NEAR(coarse, fine, 1e-6);
            double sum = 0;
            constexpr int parts = 400;
            for (int i = 0; i < parts; ++i)
                for (std::size_t k = 0; k < 10; ++k) {
                    // Narrow steps at both ends; the inner integral is that of ln r over b by its
                    // antiderivative.
                    const double x = pi_d * (i + rule.node[k]) / parts, s = 0.5 - 0.5 * std::cos(x);
                    const double along = s * std::cos(angle);
                    const double across = std::hypot(s * std::sin(angle), lift);
                    const auto part = [&](double t) {
                        const double rr = t * t + across * across;
                        return rr == 0 ? 0 : t / 2 * std::log(rr) - t + across * std::atan2(t, across);
                    };
                    sum += rule.weight[k] / parts * pi_d / 2 * std::sin(x) * (part(1 - along) - part(-along));
                }
            EXPECT_NEAR(fine, std::cos(angle) * sum, 1e-10) << "lift " << lift << ", angle " << angle;
        }
}

}  // namespace
}  // namespace afterglow
