#include <array>
#include <cmath>
#include <utility>

#include <gmock/gmock.h>

#include "solver/formfactor/closed_forms.h"
#include "solver/formfactor/polygon_pair.h"
#include "tests/support/solved_world.h"

// How fast errors fall with the number of lines and with the size of patches.

namespace afterglow {
namespace {

using testing::add_box;
using testing::add_quad;
using testing::Facing;
using testing::SolvedWorld;
using testing::SolvedWorldConfig;

/// Errors at some sizes or counts, and how they fall.
class Convergence {
  public:
    /// One of several errors at x; their root mean square counts.
    void add(double x, double error) {
        if (points_.empty() || points_.back().x != x) points_.push_back({x, 0, 0});
        points_.back().squares += error * error;
        points_.back().count += 1;
    }
    /// Exponent p of the power law error ~ x^p: the slope of the regression line in logarithms.
    [[nodiscard]] double slope() const {
        double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
        const auto n = static_cast<double>(points_.size());
        for (const Point& point : points_) {
            const double x = std::log(point.x), y = std::log(point.rms());
            sum_x += x;
            sum_y += y;
            sum_xx += x * x;
            sum_xy += x * y;
        }
        return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
    }
    [[nodiscard]] double last_error() const { return points_.back().rms(); }

  private:
    struct Point {
        double x, squares, count;
        [[nodiscard]] double rms() const { return std::sqrt(squares / count); }
    };
    std::vector<Point> points_;
};

constexpr std::array<Index, 4> line_counts{64, 256, 1024, 4096};

void record(const std::string& name, const Convergence& convergence) {
    ::testing::Test::RecordProperty(name + "_slope", std::to_string(convergence.slope()));
    ::testing::Test::RecordProperty(name + "_last_error", std::to_string(convergence.last_error()));
}

/// A cube of 1 m; its faces are low z, high z, floor, ceiling, low x, high x.
World cube() {
    World world = testing::empty_world(0.5F, Vec3(0.5F));
    add_box(world.bodies[furniture], Vec3(0), Vec3(1), 0, Facing::inwards);
    world.background = Rgb(1);
    return world;
}

std::vector<Index> patches_of_face(const SolvedWorld& solved, Index face) {
    return solved.patches_of(solved.mesh.surfaces.of_triangle[furniture][2 * face], Side::front);
}

Index surface_of_face(const SolvedWorld& solved, Index face) {
    return solved.mesh.surfaces.of_triangle[furniture][2 * face];
}

TEST(Convergence, FactorsOfPatchesByTheNumberOfSightLines) {
    const std::array<Vec3d, 4> ceiling{Vec3d(0, 1, 0), Vec3d(1, 1, 0), Vec3d(1, 1, 1), Vec3d(0, 1, 1)};
    Convergence convergence;
    for (const Index lines : line_counts) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            SolvedWorldConfig config;
            config.patch_size_m = 0.25F;
            config.lines = lines;
            config.seed = seed;
            SolvedWorld solved(cube(), config);
            solved.look(0);
            for (const Index patch : patches_of_face(solved, 2)) {
                // Squares all: centre and edge say where the patch is.
                const Vec3d c(solved.mesh.centre[patch]);
                constexpr double half = 0.125;
                const std::array<Vec3d, 4> square{c + Vec3d(-half, 0, -half), c + Vec3d(-half, 0, half),
                                                  c + Vec3d(half, 0, half), c + Vec3d(half, 0, -half)};
                convergence.add(lines, solved.factor_to_surface(patch, surface_of_face(solved, 3)) -
                                           polygon_form_factor(square, ceiling));
            }
        }
    }
    record("sight_lines", convergence);
    // Independent lines give −1/2; the (0,2)-sequence in direction does better.
    EXPECT_LT(convergence.slope(), -0.5);
    // Independent ones would be off by √(.2 · .8 / 4096).
    EXPECT_LT(convergence.last_error(), 0.00625);
}

/// The moving shutter at offset .5 (closed form 5), its blocker an actor, with a wall that makes the source
/// small enough for a lamp.
World shutter() {
    World world = testing::empty_world(0.5F, Vec3(0.2F, 0.3F, 0.4F));
    Body& body = world.bodies[furniture];
    add_quad(body, Vec3(-5e-4F, -5e-4F, 0), Vec3(1e-3F, 0, 0), Vec3(0, 1e-3F, 0), 0);
    add_quad(body, Vec3(-1, -1, 2), Vec3(0, 2, 0), Vec3(2, 0, 0), 1);
    add_quad(body, Vec3(-4, -4, -1), Vec3(8, 0, 0), Vec3(0, 8, 0), 0);
    Body& blocker = world.bodies.emplace_back();
    add_quad(blocker, Vec3(-0.25F, -0.25F, 0), Vec3(0.5F, 0, 0), Vec3(0, 0.5F, 0), 0);
    blocker.path.keys = {{0, {Vec3(0.5F, 0, 1), Quat(1, 0, 0, 0)}}};
    return world;
}

TEST(Convergence, AShadowedFactorByTheNumberOfLines) {
    Convergence by_sight, by_light;
    for (const Index lines : line_counts) {
        for (std::uint64_t seed = 1; seed <= 48; ++seed) {
            SolvedWorldConfig config;
            config.patch_size_m = 10;
            config.lines = lines;
            config.light_lines = lines;
            config.seed = seed;
            SolvedWorld solved(shutter(), config);
            solved.look(0);
            const Index receiver = patches_of_face(solved, 0).front();
            const PatchBlock& block = solved.sight.blocks().front();
            double from_lamp = 0;
            for (Index k = 0; k < lines; ++k)
                from_lamp += static_cast<double>(
                    solved.visible.light_contribution[solved.light.line(block, k, receiver - block.first)]);
            by_sight.add(lines, solved.factor_to_surface(receiver, surface_of_face(solved, 1)) - 0.210012674);
            by_light.add(lines, from_lamp - 0.210012674);
        }
    }
    record("shadow_by_sight_lines", by_sight);
    record("shadow_by_light_lines", by_light);
    EXPECT_LT(by_sight.slope(), -0.5);
    EXPECT_LT(by_light.slope(), -0.5);
    EXPECT_LT(by_light.last_error(), by_sight.last_error());
}

/// Exact mean indirect irradiance of the floor of a black cube whose ceiling shines with 1 W/m² and whose one
/// wall (low x) reflects: ρ ∫ F(point → ceiling) F(point → floor) over the wall, by the midpoint rule on a
/// grid that is fine towards the edges.
double exact_by_way_of_wall(double reflectance) {
    const std::array<Vec3d, 4> ceiling{Vec3d(0, 1, 0), Vec3d(1, 1, 0), Vec3d(1, 1, 1), Vec3d(0, 1, 1)};
    const std::array<Vec3d, 4> floor{Vec3d(0, 0, 0), Vec3d(0, 0, 1), Vec3d(1, 0, 1), Vec3d(1, 0, 0)};
    constexpr int n = 400;
    double sum = 0;
    // y = (1 − cos πt)/2 crowds the points where the integrand bends most.
    const auto place = [](int i) { return 0.5 - 0.5 * std::cos(M_PI * i / n); };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const double y = 0.5 * (place(i) + place(i + 1)), z = 0.5 * (place(j) + place(j + 1));
            const PointReceiver at{Vec3d(0, y, z), Vec3d(1, 0, 0)};
            sum += (place(i + 1) - place(i)) * (place(j + 1) - place(j)) * point_to_polygon(at, ceiling) *
                   point_to_polygon(at, floor);
        }
    }
    return reflectance * sum;
}

TEST(Convergence, IndirectLightByTheSizeOfPatches) {
    constexpr double reflectance = 0.8;
    World world = cube();
    world.background = Rgb(0);
    world.materials = {testing::diffuse("black", Rgb(0)), testing::diffuse("lamp", Rgb(0), Rgb(1 / pi)),
                       testing::diffuse("wall", Rgb(static_cast<float>(reflectance)))};
    for (const auto& [face, material] : {std::pair(3U, 1U), std::pair(4U, 2U)})
        for (const Index t : {2 * face, 2 * face + 1})
            world.bodies[furniture].triangles[t].material = material;
    const double exact = exact_by_way_of_wall(reflectance);
    Convergence convergence;
    for (const int cells : {1, 2, 4, 8}) {
        double mean = 0;
        constexpr int seeds = 8;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            SolvedWorldConfig config;
            config.patch_size_m = 1 / static_cast<float>(cells);
            config.lines = static_cast<Index>(65536 / (cells * cells));
            config.seed = seed;
            config.asked_error = 1e-5;
            SolvedWorld solved(world, config);
            solved.solve(0);
            for (const Index p : patches_of_face(solved, 2)) {
                const double direct = solved.factor_to_surface(p, surface_of_face(solved, 3));
                mean += static_cast<double>(solved.mesh.area_m2[p]) *
                        (static_cast<double>(solved.solution.state.irradiance[p].x) - direct) / seeds;
            }
        }
        convergence.add(1.0 / cells, mean / exact - 1);
    }
    record("patch_size", convergence);
    // Constant light over a patch errs by the square of its size. The noise of 8 · 65,536 lines a face is a
    // tenth of the last error.
    EXPECT_GT(convergence.slope(), 1.8);
    EXPECT_LT(convergence.last_error(), 0.005);
}

}  // namespace
}  // namespace afterglow
