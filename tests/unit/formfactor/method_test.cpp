#include "solver/formfactor/method.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "solver/formfactor/closed_forms.h"
#include "solver/formfactor/rows.h"
#include "solver/visibility/strategy.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::add_actor;
using testing::add_box;
using testing::add_quad;

/// A world with patches on the fronts only, placed, and its sight lines.
struct Placed {
    World world;
    RayCaster caster;
    PatchMesh mesh;
    SightLines lines;

    Placed(World w, float patch_size_m, Index lines_per_patch)
        : world(std::move(w)),
          caster(world),
          mesh(mesh_fronts(world, patch_size_m)),
          lines(mesh, world, lines_per_patch, 1) {}
    Placed(const Placed&) = delete;
    Placed& operator=(const Placed&) = delete;

    static PatchMesh mesh_fronts(const World& world, float size) {
        Surfaces surfaces = find_surfaces(world, {.facet_size_m = size});
        const SideMask fronts(surfaces.list.size(), {true, false});
        return make_patches(world, std::move(surfaces), fronts, {.patch_size_m = size});
    }
    [[nodiscard]] PlacedPatches patches() const { return {mesh, caster}; }
    [[nodiscard]] std::vector<std::unique_ptr<FormFactorMethod>> methods() const {
        std::vector<std::unique_ptr<FormFactorMethod>> out;
        out.push_back(make_analytic());
        out.push_back(make_hemicube({.hemicube = {.resolution = 64}}));
        out.push_back(make_ray_cast(lines));
        return out;
    }
};

World cube() {
    World world = testing::empty_world();
    add_box(world.bodies[furniture], Vec3(0), Vec3(1), 0, testing::Facing::inwards);
    return world;
}

/// A unit square facing up, and as an actor one that faces down, at a gap of 1 unless moved.
World two_squares() {
    World world = testing::empty_world();
    add_quad(world.bodies[furniture], Vec3(-.5F, -.5F, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), 0);
    Body& lid = world.bodies.emplace_back();
    lid.name = "lid";
    lid.path.keys = {{0, {Vec3(0, 0, 1), Quat(1, 0, 0, 0)}}};
    add_quad(lid, Vec3(-.5F, -.5F, 0), Vec3(0, 1, 0), Vec3(1, 0, 0), 0);
    return world;
}

/// The floor of a closed room under a table, with an actor.
World furnished() {
    World world = testing::empty_world();
    add_box(world.bodies[furniture], Vec3(0), Vec3(4, 4, 3), 0, testing::Facing::inwards);
    add_box(world.bodies[furniture], Vec3(1, 1, 1), Vec3(2.2F, 2, 1.1F), 0);
    Path path;
    path.keys = {{0, {Vec3(3, 2.5F, 1), glm::angleAxis(.5F, Vec3(0, 0, 1))}}};
    add_actor(world, "walker", Vec3(.3F, .2F, .8F), 0, path);
    return world;
}

double sum_of(const FormFactorRow& row) {
    return std::accumulate(row.factor.begin(), row.factor.end(), 0.0);
}

double standard_error(double f, double lines) {
    return std::sqrt(f * (1 - f) / lines);
}

TEST(Method, NamesAreThoseOfTheReport) {
    const Placed scene(cube(), 1, 16);
    std::vector<std::string> names;
    for (const auto& method : scene.methods()) names.emplace_back(method->name());
    EXPECT_EQ(names, (std::vector<std::string>{"analytic", "hemicube", "ray-cast"}));
}

TEST(Method, FacesOfACubeTouchAndHaveTheirClosedForms) {
    // One patch a face, all touching four others along edges: where point-to-point estimates give .318.
    const Placed scene(cube(), 1, 4096);
    ASSERT_EQ(scene.mesh.size(), 6U);
    const FormFactorRow analytic = make_analytic()->row(scene.patches(), 0);
    const FormFactorRow hemicube =
        make_hemicube({.hemicube = {.resolution = 128}, .points_per_edge = 16})->row(scene.patches(), 0);
    const FormFactorRow rays = make_ray_cast(scene.lines)->row(scene.patches(), 0);
    for (Index p = 1; p < 6; ++p) {
        const double expected = p == 1 ? .199824895698 : .200043776075;
        EXPECT_NEAR(analytic.factor[p], expected, 1e-9) << p;
        EXPECT_NEAR(hemicube.factor[p], expected, 1e-3) << p;
        EXPECT_NEAR(rays.factor[p], expected, 3 * standard_error(expected, 4096)) << p;
    }
    // The centre alone does not stand for a patch that others touch.
    const FormFactorRow centre = make_hemicube()->row(scene.patches(), 0);
    EXPECT_NEAR(centre.factor[1], .239456470, 2e-3);
    EXPECT_GT(std::abs(centre.factor[1] - .199824895698), .03);
}

TEST(Method, NearSquaresStayBelowOne) {
    // A tenth apart, where the estimate between centres is 32.
    Placed scene(two_squares(), 1, 4096);
    scene.caster.set_poses(std::vector<Pose>{{}, {Vec3(0, 0, .1F), Quat(1, 0, 0, 0)}});
    for (const Index p : {0U, 1U}) {
        EXPECT_NEAR(make_analytic()->row(scene.patches(), p).factor[1 - p], .826994522, 1e-7);
        EXPECT_NEAR(make_ray_cast(scene.lines)->row(scene.patches(), p).factor[1 - p], .826994522,
                    3 * standard_error(.827, 4096));
        const auto hemicube = make_hemicube({.hemicube = {.resolution = 64}, .points_per_edge = 24});
        EXPECT_NEAR(hemicube->row(scene.patches(), p).factor[1 - p], .826994522, 5e-3);
    }
}

TEST(Method, ActorsCountWhereTheyStand) {
    Placed scene(two_squares(), 1, 4096);
    // Turned over and about, and then set back in front by half a turn: the same pair of squares.
    const Quat about = glm::angleAxis(pi / 2, Vec3(0, 0, 1));
    for (const float gap : {.5F, 1.F, 2.F}) {
        scene.caster.set_poses(std::vector<Pose>{{}, {Vec3(0, 0, gap), about}});
        const double expected = parallel_rectangles(1, 1, static_cast<double>(gap));
        EXPECT_NEAR(make_analytic()->row(scene.patches(), 0).factor[1], expected, 1e-6) << gap;
        EXPECT_NEAR(make_analytic()->row(scene.patches(), 1).factor[0], expected, 1e-6) << gap;
        EXPECT_NEAR(make_ray_cast(scene.lines)->row(scene.patches(), 1).factor[0], expected,
                    3 * standard_error(expected, 4096))
            << gap;
        const auto hemicube = make_hemicube({.hemicube = {.resolution = 128}, .points_per_edge = 8});
        EXPECT_NEAR(hemicube->row(scene.patches(), 1).factor[0], expected, 2e-3) << gap;
    }
    // Turned away.
    scene.caster.set_poses(std::vector<Pose>{{}, {Vec3(0, 0, 1), glm::angleAxis(pi, Vec3(1, 0, 0))}});
    for (const auto& method : scene.methods()) {
        EXPECT_EQ(method->row(scene.patches(), 0).factor[1], 0) << method->name();
        EXPECT_EQ(method->row(scene.patches(), 1).factor[0], 0) << method->name();
    }
}

TEST(Method, RowsOfAClosedBoxSumToOne) {
    const Placed scene(cube(), .25F, 64);
    for (const auto& method : scene.methods())
        for (Index p = 0; p < scene.mesh.size(); ++p) {
            const FormFactorRow row = method->row(scene.patches(), p);
            EXPECT_NEAR(sum_of(row), 1, 1e-6) << method->name() << ", patch " << p;
            EXPECT_NEAR(row.sky, 0, 1e-6) << method->name();
            EXPECT_NEAR(row.buried, 0, 1e-6) << method->name();
        }
}

TEST(Method, RowsOfAFurnishedRoomSumToOne) {
    const Placed scene(furnished(), .5F, 256);
    for (const auto& method : scene.methods()) {
        double mean = 0, worst = 0;
        for (Index p = 0; p < scene.mesh.size(); ++p) {
            const FormFactorRow row = method->row(scene.patches(), p);
            mean += sum_of(row) / scene.mesh.size();
            worst = std::max(worst, std::abs(sum_of(row) - 1));
            EXPECT_EQ(row.buried, 0) << method->name() << ", patch " << p;
        }
        // The analytic rows carry the sampling error of partly hidden pairs.
        const bool sampled = method->name() == "analytic";
        EXPECT_NEAR(mean, 1, sampled ? 2e-3 : 1e-5) << method->name();
        EXPECT_LT(worst, sampled ? .06 : 1e-5) << method->name();
    }
}

TEST(Method, AnOpenSceneReportsItsDeficit) {
    const Placed scene(two_squares(), 1, 4096);
    const double deficit = 1 - .199824895698;
    EXPECT_NEAR(make_analytic()->row(scene.patches(), 0).sky, deficit, 1e-9);
    EXPECT_NEAR(make_hemicube({.points_per_edge = 8})->row(scene.patches(), 0).sky, deficit, 2e-3);
    EXPECT_NEAR(make_ray_cast(scene.lines)->row(scene.patches(), 0).sky, deficit,
                3 * standard_error(deficit, 4096));
}

TEST(Method, RayCastIsWithinThreeStandardErrorsOfAnalytic) {
    const Placed scene(cube(), .25F, 1024);
    const auto analytic = make_analytic({.lines_per_pair = 0}), rays = make_ray_cast(scene.lines);
    int compared = 0, outside = 0;
    double squares = 0;
    for (Index p = 0; p < scene.mesh.size(); ++p) {
        const FormFactorRow exact = analytic->row(scene.patches(), p), cast = rays->row(scene.patches(), p);
        for (Index q = 0; q < scene.mesh.size(); ++q) {
            const double f = exact.factor[q];
            // Below ten expected lines the normal law does not hold.
            if (f * 1024 < 10) {
                EXPECT_LE(cast.factor[q] * 1024, 30) << p << ", " << q;
                continue;
            }
            const double errors = (cast.factor[q] - f) / standard_error(f, 1024);
            ++compared;
            if (std::abs(errors) > 3) ++outside;
            squares += errors * errors;
        }
    }
    EXPECT_GT(compared, 2000);
    RecordProperty("rms_of_standard_errors", std::to_string(std::sqrt(squares / compared)));
    // Stratified lines do better than independent ones, whose root mean square would be 1, with .27 %
    // outside.
    EXPECT_LT(std::sqrt(squares / compared), 1);
    EXPECT_LT(outside, 0.0027 * compared);
}

TEST(Method, RayCastGivesTheSolversRows) {
    const Placed scene(furnished(), .5F, 64);
    const auto rays = make_ray_cast(scene.lines);
    const Lamps none{{}, std::vector<Index>(scene.mesh.size(), no_index), {}, {}};
    const LightLines light(scene.mesh, scene.lines, none, 16, 1);
    VisibleLines visible = make_visible_lines(scene.mesh, scene.lines, light);
    const StaticLines background;
    make_retrace()->update({scene.mesh, scene.lines, light, scene.caster, background}, {0, 64}, visible,
                           Context(1));
    const FormFactors solver = compile_rows(scene.mesh, scene.lines, light, none, scene.caster,
                                            {visible.patch, 64, visible.light_contribution}, Context(1));
    for (Index p = 0; p < scene.mesh.size(); ++p) {
        std::vector<double> expected(scene.mesh.size(), 0.0);
        for (auto e = solver.matrix.row_begin[p]; e < solver.matrix.row_begin[p + 1]; ++e)
            expected[solver.matrix.column[e]] += static_cast<double>(solver.matrix.value[e]);
        const FormFactorRow row = rays->row(scene.patches(), p);
        double difference = 0;
        for (Index q = 0; q < scene.mesh.size(); ++q) difference += std::abs(row.factor[q] - expected[q]);
        // Packets of other lanes may break ties on edges differently.
        EXPECT_LT(difference, 2.1 / 64) << p;
    }
}

TEST(Method, AnalyticRowsAreReciprocalHiddenPairsToo) {
    const Placed scene(furnished(), 1, 16);
    const auto analytic = make_analytic();
    std::vector<FormFactorRow> rows;
    for (Index p = 0; p < scene.mesh.size(); ++p) rows.push_back(analytic->row(scene.patches(), p));
    for (Index p = 0; p < scene.mesh.size(); ++p)
        for (Index q = 0; q < scene.mesh.size(); ++q)
            EXPECT_NEAR(static_cast<double>(scene.mesh.area_m2[p]) * rows[p].factor[q],
                        static_cast<double>(scene.mesh.area_m2[q]) * rows[q].factor[p], 1e-7)
                << p << ", " << q;
}

TEST(Method, AllMethodsAgreeOnAPartlyHiddenPair) {
    // Unit squares at a gap of 1 with a plate between them. No closed form; many lines are the reference.
    World world = two_squares();
    add_box(world.bodies[furniture], Vec3(-.1F, -.3F, .45F), Vec3(.4F, .3F, .5F), 0);
    const Placed scene(std::move(world), 1, 16384);
    const Index lid = scene.mesh.size() - 1;
    const double reference = make_ray_cast(scene.lines)->row(scene.patches(), 0).factor[lid];
    const double error = standard_error(reference, 16384);
    EXPECT_LT(reference, .15);
    EXPECT_GT(reference, .05);
    const double analytic = make_analytic({.lines_per_pair = 4096})->row(scene.patches(), 0).factor[lid];
    EXPECT_NEAR(analytic, reference, 4 * error);
    const auto hemicube = make_hemicube({.hemicube = {.resolution = 128}, .points_per_edge = 16});
    EXPECT_NEAR(hemicube->row(scene.patches(), 0).factor[lid], reference, 4 * error);
}

TEST(Method, ABallInARoomSeesTheWholeRoom) {
    World world = testing::empty_world();
    add_box(world.bodies[furniture], Vec3(0), Vec3(2), 0, testing::Facing::inwards);
    testing::add_ball(world.bodies[furniture], Vec3(1), .4F, 2, 0);
    const Placed scene(std::move(world), .5F, 256);
    const auto analytic = make_analytic();
    int curved = 0;
    for (Index p = 0; p < scene.mesh.size(); ++p) {
        if (scene.mesh.surfaces.list[scene.mesh.surface[p]].kind != Surface::Kind::curved) continue;
        ++curved;
        EXPECT_NEAR(sum_of(analytic->row(scene.patches(), p)), 1, 1e-4) << p;
        EXPECT_NEAR(sum_of(make_ray_cast(scene.lines)->row(scene.patches(), p)), 1, 1e-6) << p;
        EXPECT_NEAR(sum_of(make_hemicube({.hemicube = {.resolution = 64}})->row(scene.patches(), p)), 1, 1e-6)
            << p;
    }
    EXPECT_GT(curved, 4);
}

TEST(Method, BuriedSamplesAreLeftOut) {
    // A floor half of which lies within an actor that reaches through it; along furniture it would be cut.
    World world = testing::empty_world();
    add_quad(world.bodies[furniture], Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0), 0);
    Path path;
    path.keys = {{0, {Vec3(0, .5F, .5F), Quat(1, 0, 0, 0)}}};
    add_actor(world, "block", Vec3(.5F, 1, 1), 0, path);
    const Placed scene(std::move(world), 4, 1024);
    const auto hemicube = make_hemicube({.hemicube = {.resolution = 64}, .points_per_edge = 4});
    for (const FormFactorRow& row :
         {hemicube->row(scene.patches(), 0), make_ray_cast(scene.lines)->row(scene.patches(), 0)}) {
        EXPECT_NEAR(row.buried, .5, .01);
        EXPECT_NEAR(sum_of(row) + row.sky, 1, 1e-9);
        EXPECT_GT(row.sky, .5);
    }
}

TEST(Method, RejectsWhatIsNotThere) {
    const Placed scene(cube(), 1, 16);
    for (const auto& method : scene.methods()) EXPECT_THROW((void)method->row(scene.patches(), 6), Error);
    EXPECT_THROW(make_hemicube({.points_per_edge = 0}), Error);
    EXPECT_THROW(make_hemicube({.hemicube = {.resolution = 7}}), Error);
}

}  // namespace
}  // namespace afterglow
