#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <gmock/gmock.h>

#include "solver/formfactor/closed_forms.h"
#include "solver/formfactor/hemicube.h"
#include "tests/support/solved_world.h"

// Closed forms 5 and 6: something moves between a receiver and what it sees. The mover is an actor, so that
// it passes through the strategies of visibility.

namespace afterglow {
namespace {

using testing::add_quad;
using testing::SolvedWorld;
using testing::SolvedWorldConfig;

class MovingOccluder : public ::testing::TestWithParam<Visibility> {};
INSTANTIATE_TEST_SUITE_P(Analytic, MovingOccluder,
                         ::testing::Values(Visibility::retrace, Visibility::back_buffer,
                                           Visibility::temporal_graph, Visibility::events),
                         [](const auto& test) { return testing::test_name(test.param); });

/// A flat actor in the plane z, around the path's x, that is at `from` at time 0 and moves 1 m/s along x.
void add_slider(World& world, float half_x, float half_y, float z, float from, float seconds) {
    Body& body = world.bodies.emplace_back();
    body.name = "slider";
    add_quad(body, Vec3(-half_x, -half_y, 0), Vec3(2 * half_x, 0, 0), Vec3(0, 2 * half_y, 0), 0);
    body.path.keys = {{0, {Vec3(from, 0, z), Quat(1, 0, 0, 0)}},
                      {seconds, {Vec3(from + seconds, 0, z), Quat(1, 0, 0, 0)}}};
}

Index surface_of(const SolvedWorld& solved, Index triangle) {
    return solved.mesh.surfaces.of_triangle[furniture][triangle];
}

/// F of the shutter for any offset: the source less the part of it that the blocker's shadow covers.
double shutter_factor(double offset) {
    const auto square = [](double x0, double x1, double y) {
        // Front towards the receiver below.
        const std::array<Vec3d, 4> corners{Vec3d(x0, -y, 2), Vec3d(x0, y, 2), Vec3d(x1, y, 2),
                                           Vec3d(x1, -y, 2)};
        return point_to_polygon({}, corners);
    };
    // From z = 1 the blocker's shadow on z = 2 is twice as large and twice as far out.
    const double low = std::clamp(2 * offset - 0.5, -1.0, 1.0),
                 high = std::clamp(2 * offset + 0.5, -1.0, 1.0);
    return square(-1, 1, 1) - (high > low ? square(low, high, 0.5) : 0.0);
}

constexpr std::array shutter_values{std::pair(0.0, .165978836),  std::pair(0.125, .167902800),
                                    std::pair(0.25, .173273857), std::pair(0.375, .192190772),
                                    std::pair(0.5, .210012674),  std::pair(0.625, .225910612),
                                    std::pair(0.75, .239456470), std::pair(0.9, .239456470)};

TEST(Shutter, TheListedValuesAreThoseOfTheClosedForm) {
    for (const auto& [offset, factor] : shutter_values) {
        EXPECT_NEAR(shutter_factor(offset), factor, 1e-9) << offset;
        EXPECT_NEAR(shutter_factor(-offset), factor, 1e-9) << -offset;
    }
}

/// A receiver of 1 mm at the origin, a shining square above, the shutter between, and a dark wall below that
/// makes the square small enough for a lamp.
World shutter() {
    World world = testing::empty_world(0.5F, Vec3(0.2F, 0.3F, 0.4F));
    Body& body = world.bodies[furniture];
    add_quad(body, Vec3(-5e-4F, -5e-4F, 0), Vec3(1e-3F, 0, 0), Vec3(0, 1e-3F, 0), 0);
    add_quad(body, Vec3(-1, -1, 2), Vec3(0, 2, 0), Vec3(2, 0, 0), 1);
    add_quad(body, Vec3(-4, -4, -1), Vec3(8, 0, 0), Vec3(0, 8, 0), 0);
    add_slider(world, 0.25F, 0.25F, 1, -1, 2);
    return world;
}

TEST_P(MovingOccluder, AShutterHasItsClosedFormAtEveryOffset) {
    SolvedWorldConfig config;
    config.patch_size_m = 10;
    config.lines = 65536;
    config.light_lines = 4096;
    config.visibility = GetParam();
    SolvedWorld solved(shutter(), config);
    ASSERT_EQ(solved.lamps.list.size(), 1U);
    const auto receivers = solved.patches_of(surface_of(solved, 0), Side::front);
    ASSERT_EQ(receivers.size(), 1U);
    const Index receiver = receivers.front();
    double largest_by_sight = 0, largest_by_light = 0;
    for (const auto& [offset, factor] : shutter_values) {
        for (const double sign : {-1.0, 1.0}) {
            solved.look(1 + sign * offset);
            const double by_sight = solved.factor_to_surface(receiver, surface_of(solved, 2));
            double by_light = 0;
            const PatchBlock& block = solved.sight.blocks()[receiver / block_size];
            ASSERT_EQ(block.first, 0U);
            for (Index k = 0; k < solved.light.lines_per_patch(); ++k)
                by_light += static_cast<double>(
                    solved.visible.light_contribution[solved.light.line(block, k, receiver - block.first)]);
            // The receiver's size and lift change F by less than 1e-4; the rest is for the lines: independent
            // ones would have standard errors of 1.6e-3 (sight) and about as much (light).
            EXPECT_NEAR(by_sight, factor, 1e-3) << "sight lines, offset " << sign * offset;
            EXPECT_NEAR(by_light, factor, 1e-3) << "light lines, offset " << sign * offset;
            largest_by_sight = std::max(largest_by_sight, std::abs(by_sight - factor));
            largest_by_light = std::max(largest_by_light, std::abs(by_light - factor));
        }
    }
    RecordProperty("largest_error_of_sight_lines", std::to_string(largest_by_sight));
    RecordProperty("largest_error_of_light_lines", std::to_string(largest_by_light));
}

constexpr double sweep_step_m = 0.004;
constexpr int sweep_steps = 200;

/// How much a factor goes up and down in all while the shutter moves from 0 to 0.8 m in steps far smaller
/// than a pixel, as a multiple of what the exact one does; and the largest step of a single frame, likewise.
struct Variation {
    double all = 0, largest_step = 0;
};

template <class Factor>
Variation variation_of(const Factor& factor_at) {
    Variation out;
    double exact = 0, exact_step = 0;
    double before = factor_at(0), exact_before = shutter_factor(0);
    for (int k = 1; k <= sweep_steps; ++k) {
        const double offset = k * sweep_step_m, now = factor_at(offset), exact_now = shutter_factor(offset);
        out.all += std::abs(now - before);
        out.largest_step = std::max(out.largest_step, std::abs(now - before));
        exact += std::abs(exact_now - exact_before);
        exact_step = std::max(exact_step, std::abs(exact_now - exact_before));
        before = now;
        exact_before = exact_now;
    }
    return {out.all / exact, out.largest_step / exact_step};
}

Variation of_hemicube(int resolution, double angle) {
    const Hemicube hemicube({.resolution = resolution});
    const auto turned = [&](double x, double y, double z) {
        return Vec3d(std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y, z);
    };
    const auto square = [&](double middle, double half, double z) {
        return std::array{turned(middle - half, -half, z), turned(middle - half, half, z),
                          turned(middle + half, half, z), turned(middle + half, -half, z)};
    };
    const auto source = square(0, 1, 2);
    return variation_of([&](double offset) {
        const auto blocker = square(offset, 0.25, 1);
        const std::array<HemicubePolygon, 2> seen{HemicubePolygon{source, 0}, HemicubePolygon{blocker, 1}};
        return hemicube.look({}, seen, 2).factor[0];
    });
}

Variation of_lines(Visibility visibility, Index lines) {
    SolvedWorldConfig config;
    config.patch_size_m = 10;
    config.lines = lines;
    config.light_lines = 16;
    config.visibility = visibility;
    SolvedWorld solved(shutter(), config);
    const Index receiver = solved.patches_of(surface_of(solved, 0), Side::front).front();
    const Index source = surface_of(solved, 2);
    return variation_of([&](double offset) {
        solved.look(1 + offset);
        return solved.factor_to_surface(receiver, source);
    });
}

TEST(Shutter, FixedLinesJumpLessThanAsManyPixels) {
    for (const int resolution : {32, 64}) {
        // A hemicube has so many pixels.
        const auto lines = static_cast<Index>(3 * resolution * resolution);
        const Variation events = of_lines(Visibility::events, lines);
        const Variation along = of_hemicube(resolution, 0), across = of_hemicube(resolution, 0.3);
        const std::string size = std::to_string(resolution);
        for (const auto& [name, variation] : {std::pair("lines_", events), std::pair("pixels_along_", along),
                                              std::pair("pixels_across_", across)})
            ::testing::Test::RecordProperty(
                name + size, std::to_string(variation.all) + " " + std::to_string(variation.largest_step));
        EXPECT_GE(events.all, 1 - 1e-2) << resolution;
        // Across pixel rows single pixels turn, along them whole columns at once: ripples here, steps there.
        EXPECT_LT(events.all, across.all) << resolution;
        EXPECT_LT(events.largest_step, along.largest_step / 2) << resolution;
    }
    // What events show is what tracing shows, in every frame.
    const Variation events = of_lines(Visibility::events, 1024), cast = of_lines(Visibility::retrace, 1024);
    EXPECT_EQ(events.all, cast.all);
    EXPECT_EQ(events.largest_step, cast.largest_step);
}

/// Hottel's crossed strings for a blocker of width b at mid-gap between unit strips at gap 1.
double strips(double offset, double b) {
    const auto visible_part = [](double x) {
        if (x < -0.5) return 0.0;
        if (x <= 0) return std::sqrt((x + 0.5) * (x + 0.5) + 0.25) - 0.5;
        const double all = std::sqrt(2.0) - 1;
        return x <= 0.5 ? all + 0.5 - std::sqrt((0.5 - x) * (0.5 - x) + 0.25) : all;
    };
    return visible_part(offset - b / 2) + visible_part(-offset - b / 2);
}

TEST_P(MovingOccluder, ABlockerBetweenStripsHasHottelsForm) {
    constexpr float half_length = 50;
    double largest = 0;
    for (const float width : {0.4F, 1.0F}) {
        World world = testing::empty_world(0.5F, Vec3(0.1F, 0, 0.3F));
        world.background = Rgb(1);  // so that everything is reached
        Body& body = world.bodies[furniture];
        add_quad(body, Vec3(-0.5F, -0.5F, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), 0);
        add_quad(body, Vec3(-0.5F, -half_length, 1), Vec3(0, 2 * half_length, 0), Vec3(1, 0, 0), 0);
        add_slider(world, width / 2, half_length, 0.5F, -1.5F, 3);
        SolvedWorldConfig config;
        config.patch_size_m = 200;
        config.lines = 65536;
        config.visibility = GetParam();
        SolvedWorld solved(std::move(world), config);
        const auto receivers = solved.patches_of(surface_of(solved, 0), Side::front);
        ASSERT_EQ(receivers.size(), 1U);
        for (const double offset : {-1.2, -0.7, -0.5, -0.2, -0.1, 0.0, 0.1, 0.2, 0.35, 0.5, 0.7, 1.2}) {
            solved.look(1.5 + offset);
            const double factor = solved.factor_to_surface(receivers.front(), surface_of(solved, 2));
            // What leaves past the strips' ends is at most (gap / half length)² / 2 = 2e-4; the lift of 1e-5
            // of the scene's extent, 1e-3 m, takes at most 0.3 times itself from the gap: 3e-4. The rest is
            // for the lines.
            EXPECT_NEAR(factor, strips(offset, static_cast<double>(width)), 1.5e-3)
                << "offset " << offset << ", width " << width;
            largest = std::max(largest, std::abs(factor - strips(offset, static_cast<double>(width))));
        }
    }
    RecordProperty("largest_error", std::to_string(largest));
}

}  // namespace
}  // namespace afterglow
