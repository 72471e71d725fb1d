#include "solver/formfactor/hemicube.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "solver/formfactor/closed_forms.h"

namespace afterglow {
namespace {

using Polygon = std::vector<Vec3d>;

Polygon rectangle(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
    return {corner, corner + u, corner + u + v, corner + v};
}

/// What a hemicube at the origin, facing +z, sees of polygons that are an item each.
HemicubeView view_of(const std::vector<Polygon>& polygons, const Hemicube& hemicube,
                     const HemicubeEye& eye = {}) {
    std::vector<HemicubePolygon> list;
    for (const Polygon& p : polygons) list.push_back({p, static_cast<Index>(list.size())});
    return hemicube.look(eye, list, list.size());
}

/// The six walls of a box around the origin, seen from inside.
std::vector<Polygon> box(const Vec3d& low, const Vec3d& high) {
    const Vec3d x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
    return {rectangle(low, x, y),     rectangle(low + z, y, x), rectangle(low, y, z),
            rectangle(low + x, z, y), rectangle(low, z, x),     rectangle(low + y, x, z)};
}

TEST(Hemicube, PixelsSumToOneAndAreExact) {
    for (const int n : {2, 4, 32, 256, 1024}) {
        const Hemicube hemicube({.resolution = n});
        double top = 0, side = 0;
        for (int row = 0; row < n; ++row)
            for (int column = 0; column < n; ++column) {
                top += hemicube.top_delta(column, row);
                if (row < n / 2) side += hemicube.side_delta(column, row);
            }
        EXPECT_NEAR(top + 4 * side, 1, 1e-12) << n;
        EXPECT_NEAR(top, 4 * .138531606, 1e-8) << n;
    }
    // One pixel of a coarse cube is a rectangle with a closed form of its own.
    const Hemicube coarse({.resolution = 4});
    const Polygon top = rectangle(Vec3d(.5, 0, 1), Vec3d(0, .5, 0), Vec3d(.5, 0, 0));
    const Polygon side = rectangle(Vec3d(1, -.5, .5), Vec3d(0, 0, .5), Vec3d(0, .5, 0));
    EXPECT_NEAR(coarse.top_delta(3, 2), point_to_polygon({}, top), 1e-15);
    EXPECT_NEAR(coarse.side_delta(1, 1), point_to_polygon({}, side), 1e-15);
}

TEST(Hemicube, WhatFillsWholePixelsIsExact) {
    // Half of the top face, all of it, and a wall that begins at the horizon: edges between pixels.
    const Hemicube hemicube({.resolution = 16});
    const HemicubeView view = view_of({rectangle(Vec3d(0, -1, 1), Vec3d(1, 0, 0), Vec3d(0, 2, 0)),
                                       rectangle(Vec3d(-2, -2, 2), Vec3d(4, 0, 0), Vec3d(0, 4, 0)),
                                       rectangle(Vec3d(3, -3, 0), Vec3d(0, 6, 0), Vec3d(0, 0, 3))},
                                      hemicube);
    EXPECT_NEAR(view.factor[0], 2 * .138531606, 1e-8);
    EXPECT_NEAR(view.factor[1], 2 * .138531606, 1e-8);
    EXPECT_NEAR(view.factor[2], 2 * .055734197, 1e-8);
    EXPECT_NEAR(view.sky, 1 - 4 * .138531606 - 2 * .055734197, 1e-8);
}

TEST(Hemicube, WithNothingAroundAllIsSky) {
    const HemicubeView view = Hemicube({.resolution = 64}).look({}, {}, 3);
    EXPECT_EQ(view.factor, std::vector<double>(3, 0.0));
    EXPECT_NEAR(view.sky, 1, 1e-13);
}

TEST(Hemicube, InsideAClosedBoxNoSkyIsSeenFromAnywhere) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> unit(0, 1);
    const Hemicube hemicube({.resolution = 64});
    const auto walls = box(Vec3d(-1, -2, -1), Vec3d(1, 1, 3));
    for (int k = 0; k < 50; ++k) {
        // The first points lie in the symmetry planes, where edges run through pixel centres.
        const HemicubeEye eye{
            k < 3 ? Vec3d(0) : Vec3d(2 * unit(generator) - 1, 3 * unit(generator) - 2, unit(generator)),
            glm::normalize(k < 3 ? Vec3d(k == 0, k == 1, k == 2)
                                 : Vec3d(unit(generator), unit(generator), unit(generator)) - .5)};
        const HemicubeView view = view_of(walls, hemicube, eye);
        EXPECT_EQ(view.sky, 0) << k;
        double sum = 0;
        for (const double f : view.factor) sum += f;
        EXPECT_NEAR(sum, 1, 1e-12) << k;
    }
}

TEST(Hemicube, TheNearestIsSeenInAnyOrder) {
    const Hemicube hemicube({.resolution = 128});
    const Polygon far = rectangle(Vec3d(-1, -1, 2), Vec3d(0, 2, 0), Vec3d(2, 0, 0));
    const Polygon near = rectangle(Vec3d(-.25, -.25, 1), Vec3d(0, .5, 0), Vec3d(.5, 0, 0));
    const HemicubeView one = view_of({far, near}, hemicube), two = view_of({near, far}, hemicube);
    EXPECT_EQ(one.factor[0], two.factor[1]);
    EXPECT_EQ(one.factor[1], two.factor[0]);
    EXPECT_NEAR(one.factor[0], .165978836, 5e-3);
    // Polygons through each other: the nearer part of each. By symmetry half of each is seen.
    const HemicubeView crossed = view_of({rectangle(Vec3d(-1, -1, 1), Vec3d(2, 0, 1), Vec3d(0, 2, 0)),
                                          rectangle(Vec3d(-1, -1, 2), Vec3d(2, 0, -1), Vec3d(0, 2, 0))},
                                         hemicube);
    EXPECT_NEAR(crossed.factor[0], crossed.factor[1], 1e-12);
    EXPECT_GT(crossed.factor[0], .2);
}

TEST(Hemicube, WhatHasNoItemHides) {
    const Hemicube hemicube({.resolution = 128});
    const Polygon far = rectangle(Vec3d(-1, -1, 2), Vec3d(0, 2, 0), Vec3d(2, 0, 0));
    const Polygon near = rectangle(Vec3d(-.25, -.25, 1), Vec3d(0, .5, 0), Vec3d(.5, 0, 0));
    const std::vector<HemicubePolygon> list{{far, 0}, {near, no_index}};
    const HemicubeView view = hemicube.look({}, list, 1);
    EXPECT_NEAR(view.factor[0], .165978836, 5e-3);
    EXPECT_NEAR(view.factor[0] + view.hidden, view_of({far}, hemicube).factor[0], 1e-12);
    EXPECT_NEAR(view.factor[0] + view.hidden + view.sky, 1, 1e-12);
}

TEST(Hemicube, WhatReachesBehindTheEyeIsCutAndNotMirrored) {
    // A floor and a wall that pass the eye on all sides, and a ceiling that begins behind it.
    const Hemicube hemicube({.resolution = 512});
    const Polygon wall = rectangle(Vec3d(1, -50, -50), Vec3d(0, 0, 100), Vec3d(0, 100, 0));
    const Polygon floor = rectangle(Vec3d(-50, -50, -.01), Vec3d(100, 0, 0), Vec3d(0, 100, 0));
    const Polygon slope{{-10, -10, -5}, {-10, 10, -5}, {30, 10, 15}, {30, -10, 15}};
    const HemicubeView view = view_of({wall, floor}, hemicube);
    EXPECT_NEAR(view.factor[0], point_to_polygon({}, wall), 5e-4);
    EXPECT_EQ(view.factor[1], 0);
    const HemicubeView alone = view_of({slope}, hemicube, {Vec3d(0, 0, -1), Vec3d(0, 0, 1)});
    Polygon front = slope;
    if (plane_of(front).height(Vec3d(0, 0, -1)) < 0) std::reverse(front.begin(), front.end());
    EXPECT_NEAR(alone.factor[0], point_to_polygon({Vec3d(0, 0, -1)}, front), 1e-3);
    // The near plane: what lies before it is not there.
    const Polygon close = rectangle(Vec3d(-3e-6, -3e-6, 1e-6), Vec3d(0, 6e-6, 0), Vec3d(6e-6, 0, 0));
    EXPECT_GT(view_of({close}, hemicube).factor[0], .8);
    EXPECT_EQ(view_of({close}, Hemicube({.resolution = 64, .near_m = 1e-5})).factor[0], 0);
}

TEST(Hemicube, APolygonSeenEdgeOnIsNotSeen) {
    const Polygon upright = rectangle(Vec3d(1, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 0, 1));
    EXPECT_EQ(view_of({upright}, Hemicube({.resolution = 64})).factor[0], 0);
}

/// RMS error, relative to the mean form factor, of 150 random triangles seen from the origin.
double random_triangles_error(int resolution) {
    std::mt19937 generator(7);
    std::normal_distribution<double> normal;
    const Hemicube hemicube({.resolution = resolution});
    double squares = 0, sum = 0;
    for (int k = 0; k < 150; ++k) {
        const auto vector = [&] { return Vec3d(normal(generator), normal(generator), normal(generator)); };
        const Vec3d centre = vector() + Vec3d(0, 0, 2);
        Polygon triangle{centre + .7 * vector(), centre + .7 * vector(), centre + .7 * vector()};
        if (plane_of(triangle).height(Vec3d(0)) < 0) std::reverse(triangle.begin(), triangle.end());
        const double exact = point_to_polygon({}, triangle);
        const double error = view_of({triangle}, hemicube).factor[0] - exact;
        squares += error * error;
        sum += exact;
    }
    return std::sqrt(squares / 150) / (sum / 150);
}

TEST(Hemicube, TheErrorFallsWithTheResolution) {
    // Slope of the error over 32 … 512 pixels, on logarithmic scales, by least squares. Edges that cross
    // pixels at all phases give −1.5; edges along pixel rows −1.
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    constexpr int resolutions = 5;
    for (int k = 0; k < resolutions; ++k) {
        const double x = std::log2(32 << k), error = random_triangles_error(32 << k), y = std::log2(error);
        RecordProperty("error_" + std::to_string(32 << k), std::to_string(error));
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const double slope = (resolutions * sxy - sx * sy) / (resolutions * sxx - sx * sx);
    RecordProperty("slope", std::to_string(slope));
    EXPECT_LT(slope, -1.1);
    EXPECT_GT(slope, -1.9);
    EXPECT_LT(random_triangles_error(512), 2e-3);
}

/// Form factors of closed form 5, the moving shutter turned by some angle about the axis, for a blocker that
/// moves in sub-pixel steps: how much the curve goes up and down in all, less what the exact one does.
struct Shutter {
    double total_variation = 0, worst = 0;
};

Polygon turned(Polygon polygon, double angle) {
    for (Vec3d& c : polygon)
        c = Vec3d(std::cos(angle) * c.x - std::sin(angle) * c.y,
                  std::sin(angle) * c.x + std::cos(angle) * c.y, c.z);
    return polygon;
}
const Polygon source = rectangle(Vec3d(-1, -1, 2), Vec3d(0, 2, 0), Vec3d(2, 0, 0));
Polygon blocker(double s) {
    return rectangle(Vec3d(s - .25, -.25, 1), Vec3d(0, .5, 0), Vec3d(.5, 0, 0));
}
double exact_shutter(double s) {
    // The blocker's projection onto the source's plane, twice as large, and cut off at its edge.
    const double right = std::min(2 * s + .5, 1.), left = 2 * s - .5;
    const double whole = point_to_polygon({}, source);
    if (left >= 1) return whole;
    return whole -
           point_to_polygon({}, rectangle(Vec3d(left, -.5, 2), Vec3d(0, 1, 0), Vec3d(right - left, 0, 0)));
}

Shutter move_shutter(int resolution, double angle) {
    // 400 steps of 1/500: at 32 pixels across 2 m, a 31st of a pixel each.
    const Hemicube hemicube({.resolution = resolution});
    Shutter out;
    double before = 0, exact_before = 0, exact_variation = 0;
    for (int k = 0; k <= 400; ++k) {
        const double s = k / 500.0, exact = exact_shutter(s);
        const double f = view_of({turned(source, angle), turned(blocker(s), angle)}, hemicube).factor[0];
        if (k > 0) {
            out.total_variation += std::abs(f - before);
            exact_variation += std::abs(exact - exact_before);
        }
        out.worst = std::max(out.worst, std::abs(f - exact));
        before = f;
        exact_before = exact;
    }
    out.total_variation /= exact_variation;
    return out;
}

TEST(Hemicube, TheMovingShutterHasItsClosedForm) {
    const std::vector<std::pair<double, double>> values{
        {0, .165978836},  {.125, .167902800}, {.25, .173273857}, {.375, .192190772},
        {.5, .210012674}, {.625, .225910612}, {.75, .239456470}, {1, .239456470}};
    const Hemicube hemicube({.resolution = 1024});
    for (const auto& [s, f] : values) {
        EXPECT_NEAR(exact_shutter(s), f, 1e-9) << s;
        EXPECT_NEAR(view_of({turned(source, .3), turned(blocker(s), .3)}, hemicube).factor[0], f, 3e-4) << s;
    }
}

TEST(Hemicube, AliasingAddsVariationThatFallsWithTheResolution) {
    const Shutter low = move_shutter(32, .3), middle = move_shutter(128, .3), high = move_shutter(512, .3);
    RecordProperty("variation_32", std::to_string(low.total_variation));
    RecordProperty("variation_128", std::to_string(middle.total_variation));
    RecordProperty("variation_512", std::to_string(high.total_variation));
    EXPECT_GT(low.total_variation, 1.3);
    EXPECT_LT(middle.total_variation, low.total_variation);
    EXPECT_LT(high.total_variation, middle.total_variation);
    EXPECT_GT(high.total_variation, 0.99);
    EXPECT_LT(high.total_variation, 1.1);
    EXPECT_LT(high.worst, low.worst / 8);
}

TEST(Hemicube, ASmallMovingPatchFlickers) {
    // A patch of 5 cm at 2 m, under a pixel wide at 64, 6 at 512, moves 25 cm in steps of 1.25 mm: up and
    // down in all, as a multiple of its mean form factor.
    const auto at = [](double s) {
        return turned(rectangle(Vec3d(.3 + s, .2, 2), Vec3d(0, .05, 0), Vec3d(.05, 0, 0)), .3);
    };
    const auto variation = [&](const auto& factor_at) {
        double sum = 0, all = 0, before = 0;
        for (int k = 0; k <= 200; ++k) {
            const double f = factor_at(at(k / 800.0));
            if (k > 0) sum += std::abs(f - before);
            all += f / 201;
            before = f;
        }
        return sum / all;
    };
    const double exact = variation([](const Polygon& p) { return point_to_polygon({}, p); });
    const auto with = [&](int resolution) {
        const Hemicube hemicube({.resolution = resolution});
        return variation([&](const Polygon& p) { return view_of({p}, hemicube).factor[0]; });
    };
    const double low = with(64), high = with(512);
    RecordProperty("patch_variation_exact", std::to_string(exact));
    RecordProperty("patch_variation_64", std::to_string(low));
    RecordProperty("patch_variation_512", std::to_string(high));
    EXPECT_GT(low, 20 * exact);
    EXPECT_GT(high, exact);
    EXPECT_LT(high, low / 2);
}

TEST(Hemicube, RejectsBadOptionsAndPolygons) {
    const auto place_of = [](const auto& call) {
        try {
            call();
        } catch (const Error& error) {
            return error.kind() == ErrorKind::invalid_input ? error.place() : std::string("another kind");
        }
        return std::string("nothing thrown");
    };
    for (const int n : {0, -2, 1, 33, 8194})
        EXPECT_EQ(place_of([&] { Hemicube hemicube({.resolution = n}); }), "hemicube resolution") << n;
    EXPECT_EQ(place_of([&] { Hemicube hemicube({.near_m = 0}); }), "hemicube near_m");
    const Hemicube hemicube({.resolution = 8});
    const Polygon triangle{{0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
    const std::vector<HemicubePolygon> too_large{{triangle, 1}};
    EXPECT_EQ(place_of([&] { (void)hemicube.look({}, too_large, 1); }), "hemicube polygon 0");
    const std::vector<HemicubePolygon> too_few{{std::span(triangle).first(2), 0}};
    EXPECT_EQ(place_of([&] { (void)hemicube.look({}, too_few, 1); }), "hemicube polygon 0");
}

}  // namespace
}  // namespace afterglow
