#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "solver/formfactor/method.h"
#include "tests/support/dense_solve.h"
#include "tests/support/solved_world.h"

// Closed forms 7 to 11: closed scenes, whose light is known without their form factors or from a few of them.

namespace afterglow {
namespace {

using testing::add_box;
using testing::Facing;
using testing::SolvedWorld;
using testing::SolvedWorldConfig;

/// Mean of independent values and its standard error.
struct Estimate {
    double mean = 0, standard_error = 0;

    explicit Estimate(const std::vector<double>& values) {
        const auto n = static_cast<double>(values.size());
        for (const double v : values) mean += v / n;
        double squares = 0;
        for (const double v : values) squares += (v - mean) * (v - mean);
        standard_error = std::sqrt(squares / (n * (n - 1)));
    }
};

/// Σ A v over all patches, channel r.
double power(const PatchMesh& mesh, std::span<const Rgb> values) {
    double sum = 0;
    for (Index p = 0; p < mesh.size(); ++p)
        sum += static_cast<double>(mesh.area_m2[p]) * static_cast<double>(values[p].x);
    return sum;
}

class EveryVisibility : public ::testing::TestWithParam<Visibility> {};
INSTANTIATE_TEST_SUITE_P(Analytic, EveryVisibility,
                         ::testing::Values(Visibility::retrace, Visibility::back_buffer,
                                           Visibility::temporal_graph, Visibility::events),
                         [](const auto& test) { return testing::test_name(test.param); });

TEST_P(EveryVisibility, AFurnaceIsUniformWhateverTheActorsDo) {
    for (const float reflectance : {0.1F, 0.5F, 0.9F}) {
        World world = testing::small_room();
        for (Material& material : world.materials) {
            material = testing::diffuse("furnace", Rgb(reflectance), Rgb(1));
            material.shines = Material::Shines::both;
        }
        SolvedWorldConfig config;
        config.lines = 64;
        config.visibility = GetParam();
        config.asked_error = 1e-5;
        SolvedWorld solved(std::move(world), config);
        for (const double time_s : {0.0, 0.35, 1.0, 1.9}) {
            solved.solve(time_s);
            const double expected = static_cast<double>(pi) / (1 - static_cast<double>(reflectance));
            // The certificate's own bound, and single precision in the sums of rows to 1.
            const double bound = solved.solution.certificate.error_bound *
                                     mean_reflected(solved.problem(), solved.solution.state.irradiance) +
                                 1e-5 * expected / (1 - static_cast<double>(reflectance));
            for (Index p = 0; p < solved.mesh.size(); ++p) {
                // The outside of the room shines too, into the open: it is no furnace.
                if (solved.factors.sky[p] > 0) continue;
                ASSERT_NEAR(solved.radiosity(p).x, expected, bound) << "time " << time_s << ", patch " << p;
            }
        }
    }
}

TEST_P(EveryVisibility, PowerArrivingIsInvariantUnderMotion) {
    // Closed form 8: Σ A H = Φ/(1−ρ) with one ρ for walls, actors and lamp. It needs reciprocity, which the
    // rows have on average only: so three standard errors over sixteen independent sets of lines.
    constexpr double reflectance = 0.6;
    World world = testing::small_room();
    world.materials[1].reflectance = Rgb(0.6F);
    const std::array times{0.0, 0.5, 1.0, 1.6};
    std::array<std::vector<double>, times.size()> ratio;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        SolvedWorldConfig config;
        config.visibility = GetParam();
        config.seed = seed;
        SolvedWorld solved(world, config);
        for (std::size_t t = 0; t < times.size(); ++t) {
            solved.solve(times[t]);
            const double emitted = power(solved.mesh, solved.emission);
            EXPECT_NEAR(emitted, pi, 1e-4) << "1 m² of radiance 1";
            ratio[t].push_back(power(solved.mesh, solved.solution.state.irradiance) * (1 - reflectance) /
                               emitted);
        }
    }
    for (std::size_t t = 0; t < times.size(); ++t) {
        const Estimate estimate(ratio[t]);
        // To the noise adds what the solver is allowed to leave unsolved.
        EXPECT_NEAR(estimate.mean, 1, 3 * estimate.standard_error + 1e-4) << "time " << times[t];
        EXPECT_LT(estimate.standard_error, 0.005);
        RecordProperty("power_ratio_at_" + std::to_string(t),
                       std::to_string(estimate.mean) + " +- " + std::to_string(estimate.standard_error));
    }
}

/// A point light of power Φ, W.
PlacedLight point_light(float power_w, const Vec3& position) {
    PlacedLight light;
    light.light.intensity = Rgb(power_w / (4 * pi));
    light.path.keys = {{0, {position, Quat(1, 0, 0, 0)}}};
    return light;
}

/// The light of an integrating sphere of radius 1, lit by 100 W from a point off its centre.
World sphere(float reflectance) {
    World world = testing::empty_world(reflectance);
    testing::add_ball(world.bodies[furniture], Vec3(0), 1, 4, 0);
    world.lights = {point_light(100, Vec3(0.5F, 0.1F, 0))};
    return world;
}

TEST(IntegratingSphere, EveryPatchSeesEveryPatchByItsArea) {
    // F_ij = A_j / 4πR²: how often lines meet patches must look like chance at most (a χ² test), and less,
    // since the lines are well spread.
    SolvedWorldConfig config;
    config.patch_size_m = 0.2F;
    config.lines = 4096;
    SolvedWorld solved(sphere(0.5F), config);
    solved.look(0);
    const PatchMesh& mesh = solved.mesh;
    double area = 0;
    for (const float a : mesh.area_m2) area += static_cast<double>(a);
    // 5,120 facets inside the sphere: 0.3 % short of it.
    EXPECT_NEAR(area, 4 * static_cast<double>(pi), 0.003 * area);
    double chi = 0;
    for (Index i = 0; i < mesh.size(); ++i) {
        std::vector<double> row(mesh.size(), 0);
        const FormFactorMatrix& matrix = solved.factors.matrix;
        for (auto e = matrix.row_begin[i]; e < matrix.row_begin[i + 1]; ++e)
            row[matrix.column[e]] += static_cast<double>(matrix.value[e]);
        for (Index j = 0; j < mesh.size(); ++j) {
            const double expected = static_cast<double>(mesh.area_m2[j]) / area;
            chi += std::pow(row[j] - expected, 2) * config.lines / expected;
        }
    }
    const double degrees = static_cast<double>(mesh.size()) * (mesh.size() - 1);
    // The mean of χ² over its degrees of freedom is 1, its standard error √(2/degrees).
    EXPECT_LT(chi / degrees, 1 + 3 * std::sqrt(2 / degrees));
    RecordProperty("chi_square_per_degree", std::to_string(chi / degrees));
}

TEST(IntegratingSphere, IndirectLightIsUniform) {
    for (const float reflectance : {0.2F, 0.5F, 0.9F}) {
        SolvedWorldConfig config;
        config.patch_size_m = 0.2F;
        config.lines = 1024;
        SolvedWorld solved(sphere(reflectance), config);
        solved.solve(0);
        const double total = power(solved.mesh, std::vector<Rgb>(solved.mesh.size(), Rgb(1)));
        const double direct = power(solved.mesh, solved.from_lights) / total;
        const double expected =
            100 * static_cast<double>(reflectance) / (total * (1 - static_cast<double>(reflectance)));
        // Eight points a patch bring the light's 100 W to the patches within half a percent.
        EXPECT_NEAR(direct * total, 100, 0.5);
        double mean = 0, squares = 0, direct_squares = 0;
        for (Index p = 0; p < solved.mesh.size(); ++p) {
            const double share = static_cast<double>(solved.mesh.area_m2[p]) / total;
            const double from_light = static_cast<double>(solved.from_lights[p].x);
            const double indirect = static_cast<double>(solved.solution.state.irradiance[p].x) - from_light;
            mean += share * indirect;
            squares += share * std::pow(indirect - expected, 2);
            direct_squares += share * std::pow(from_light - direct, 2);
        }
        // Each patch gathers a light of spread σ(direct)·ρ by 1,024 lines: independent ones would be off by
        // σρ/√1024; what they gather at later bounces is uniform already. 0.5 % is for the sphere's facets
        // and the points that sample the light.
        const double one_error = static_cast<double>(reflectance) * std::sqrt(direct_squares / config.lines);
        EXPECT_NEAR(mean, expected, 0.005 * expected) << reflectance;
        EXPECT_LT(std::sqrt(squares), one_error + 0.005 * expected) << reflectance;
        RecordProperty("mean_over_expected_" + std::to_string(reflectance), std::to_string(mean / expected));
    }
}

struct CubeLight {
    float reflectance;
    double emitter, opposite, side;
};
constexpr std::array cube_lights{CubeLight{0.2F, 1.00961538598, 0.0480445445, 0.0480850173566},
                                 CubeLight{0.5F, 1.09090909811, 0.181745826108, 0.181836268946},
                                 CubeLight{0.8F, 1.55172415364, 0.689551070738, 0.689681193904}};

/// A unit cube with one patch a face, the first face shining with E = 1.
World one_patch_cube(float reflectance) {
    World world = testing::empty_world(reflectance, Vec3(0.5F));
    add_box(world.bodies[furniture], Vec3(0), Vec3(1), 0, Facing::inwards);
    world.materials[1] = testing::diffuse("lamp", Rgb(reflectance), Rgb(1 / pi));
    for (std::size_t t = 0; t < 2; ++t) world.bodies[furniture].triangles[t].material = 1;
    return world;
}

TEST(UnitCube, OnePatchAFaceHasItsListedSolution) {
    for (const CubeLight& light : cube_lights) {
        FormFactorMatrix matrix;
        const std::array<double, 6> seen_from_first{
            0, .199824895698, .200043776075, .200043776075, .200043776075, .200043776075};
        for (Index i = 0; i < 6; ++i) {
            for (Index j = 0; j < 6; ++j) {
                if (i == j) continue;
                matrix.column.push_back(j);
                matrix.value.push_back(static_cast<float>(seen_from_first[i / 2 == j / 2 ? 1 : 2]));
            }
            matrix.row_begin.push_back(matrix.column.size());
        }
        const std::vector<float> area(6, 1);
        std::vector<Rgb> emission(6, Rgb(0));
        const std::vector<Rgb> reflectance(6, Rgb(light.reflectance));
        emission[0] = Rgb(1);
        const RadiosityProblem problem{matrix, area, emission, reflectance, {}};
        const auto dense = test::solve_radiosity(problem);
        // The matrix holds seven digits, and so does ρ; (1 − ρ) amplifies what they lack.
        const double digits = 2e-7 / (1 - static_cast<double>(light.reflectance));
        EXPECT_NEAR(dense[0][0], light.emitter, digits);
        EXPECT_NEAR(dense[1][0], light.opposite, digits);
        EXPECT_NEAR(dense[4][0], light.side, digits);

        ProgressiveConfig config;
        config.asked_error = 1e-5;
        const auto solution = solve_progressive(problem, columns_of(matrix, Context(1)), config, Context(1));
        const double bound =
            solution.certificate.error_bound * mean_reflected(problem, solution.state.irradiance);
        for (std::size_t p = 0; p < 6; ++p)
            EXPECT_NEAR((emission[p] + reflectance[p] * solution.state.irradiance[p]).x, dense[p][0],
                        bound + 2e-7);
    }
}

TEST(UnitCube, OnePatchAFaceByLinesHasItsListedSolution) {
    for (const CubeLight& light : cube_lights) {
        std::vector<double> emitter, opposite, side;
        for (std::uint64_t seed = 1; seed <= 32; ++seed) {
            SolvedWorldConfig config;
            config.patch_size_m = 1;
            config.lines = 8192;
            config.seed = seed;
            config.asked_error = 1e-5;
            SolvedWorld solved(one_patch_cube(light.reflectance), config);
            ASSERT_EQ(solved.mesh.size(), 6U);
            solved.solve(0);
            const auto radiosity = [&](Index triangle) {
                const Index surface = solved.mesh.surfaces.of_triangle[furniture][triangle];
                return static_cast<double>(solved.radiosity(solved.patches_of(surface, Side::front)[0]).x);
            };
            emitter.push_back(radiosity(0));
            opposite.push_back(radiosity(2));
            for (Index face = 2; face < 6; ++face) side.push_back(radiosity(2 * face));
        }
        for (const auto& [values, expected] :
             {std::pair(&emitter, light.emitter), std::pair(&opposite, light.opposite),
              std::pair(&side, light.side)}) {
            const Estimate estimate(*values);
            EXPECT_NEAR(estimate.mean, expected, 3 * estimate.standard_error + 1e-6) << light.reflectance;
            EXPECT_LT(estimate.standard_error, 2e-3 * expected);
        }
    }
}

TEST(UnitCube, OnePatchAFaceByTheAnalyticMethodHasItsListedRows) {
    SolvedWorldConfig config;
    config.patch_size_m = 1;
    SolvedWorld solved(one_patch_cube(0.5F), config);
    solved.look(0);
    const auto analytic = make_analytic();
    for (Index p = 0; p < 6; ++p) {
        auto row = analytic->row({solved.mesh, solved.caster}, p).factor;
        std::sort(row.begin(), row.end());
        EXPECT_EQ(row[0], 0);
        EXPECT_NEAR(row[1], .199824895698, 1e-7);
        for (std::size_t j = 2; j < 6; ++j) EXPECT_NEAR(row[j], .200043776075, 1e-7);
    }
}

TEST(Cie171, MeanIndirectIlluminanceOfCase58) {
    // 10,000 lm in a closed cube of 4 m: (Φ/96) ρ/(1−ρ), whatever the place of the lamp.
    for (const auto& [reflectance, expected] :
         {std::pair(0.1F, 11.574), std::pair(0.3F, 44.643), std::pair(0.5F, 104.167),
          std::pair(0.7F, 243.056), std::pair(0.9F, 937.5), std::pair(0.95F, 1979.17)}) {
        World world = testing::empty_world(reflectance);
        add_box(world.bodies[furniture], Vec3(0), Vec3(4), 0, Facing::inwards);
        world.lights = {point_light(10000, Vec3(2))};
        std::vector<double> indirect;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            SolvedWorldConfig config;
            config.patch_size_m = 0.5F;
            config.seed = seed;
            SolvedWorld solved(world, config);
            solved.solve(0);
            const double from_light = power(solved.mesh, solved.from_lights);
            // Eight points a patch.
            EXPECT_NEAR(from_light, 10000, 20);
            indirect.push_back((power(solved.mesh, solved.solution.state.irradiance) - from_light) / 96);
        }
        const Estimate estimate(indirect);
        // 0.2 % for the points above, 1e-4 for what is left unsolved.
        EXPECT_NEAR(estimate.mean, expected, 3 * estimate.standard_error + 0.0021 * expected) << reflectance;
        EXPECT_LT(estimate.standard_error, 0.002 * expected);
        RecordProperty("illuminance_at_" + std::to_string(reflectance),
                       std::to_string(estimate.mean) + " of " + std::to_string(expected));
    }
}

}  // namespace
}  // namespace afterglow
