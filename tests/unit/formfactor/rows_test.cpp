#include "solver/formfactor/rows.h"

#include <numeric>

#include <gmock/gmock.h>

#include "solver/visibility/strategy.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::add_box;
using testing::add_quad;
using testing::LinedWorld;

FormFactors factors_of(const LinedWorld& lined, int threads = 2) {
    VisibleLines visible = make_visible_lines(lined.mesh, lined.sight, lined.light);
    const StaticLines none;
    make_retrace()->update({lined.mesh, lined.sight, lined.light, lined.caster, none},
                           {0, lined.sight.lines_per_patch()}, visible, Context(threads));
    const SeenLines seen{visible.patch, lined.sight.lines_per_patch(), visible.light_contribution};
    return compile_rows(lined.mesh, lined.sight, lined.light, lined.lamps, lined.caster, seen,
                        Context(threads));
}

double row_sum(const FormFactorMatrix& matrix, Index row) {
    return std::accumulate(matrix.value.begin() + static_cast<std::ptrdiff_t>(matrix.row_begin[row]),
                           matrix.value.begin() + static_cast<std::ptrdiff_t>(matrix.row_begin[row + 1]),
                           0.0);
}

TEST(Rows, OfAClosedSceneSumToOneWithMovingActorsAndLamps) {
    LinedWorld lined(testing::small_room(), 0.3F, 64);
    for (const double time : {0.0, 0.7, 2.0}) {
        lined.caster.set_poses(poses_at(lined.world, time));
        const FormFactors factors = factors_of(lined);
        for (Index p = 0; p < lined.mesh.size(); ++p) {
            // The room's outside and the insides of solid things see the open sky, or each other; all sides
            // are meshed here.
            EXPECT_NEAR(row_sum(factors.matrix, p) + factors.sky[p], 1, 1e-4) << p;
        }
    }
}

TEST(Rows, AnOpenSceneReportsItsDeficitAsSky) {
    World world = testing::empty_world();
    add_quad(world.bodies[furniture], Vec3(0), Vec3(0, 0, 1), Vec3(1, 0, 0), 0);
    const LinedWorld lined(std::move(world), 0.5F, 16);
    const FormFactors factors = factors_of(lined);
    EXPECT_EQ(factors.matrix.entries(), 0U);
    for (const float sky : factors.sky) EXPECT_EQ(sky, 1);
}

/// Area-weighted mean over one surface's front of the form factor to another's.
double mean_factor(const LinedWorld& lined, const FormFactors& factors, Index from, Index to) {
    double sum = 0, area = 0;
    for (Index p = 0; p < lined.mesh.size(); ++p) {
        if (lined.mesh.surface[p] != from || lined.mesh.side[p] != Side::front) continue;
        area += lined.mesh.area_m2[p];
        for (auto e = factors.matrix.row_begin[p]; e < factors.matrix.row_begin[p + 1]; ++e)
            if (lined.mesh.surface[factors.matrix.column[e]] == to)
                sum += lined.mesh.area_m2[p] * factors.matrix.value[e];
    }
    return sum / area;
}

TEST(Rows, FacesOfACubeHaveTheirClosedForms) {
    World world = testing::empty_world();
    add_box(world.bodies[furniture], Vec3(0), Vec3(1), 0, testing::Facing::inwards);
    const LinedWorld lined(std::move(world), 0.125F, 1024);
    const FormFactors factors = factors_of(lined);
    // Closed forms 1 and 2: opposite faces .199825, adjacent ones .200044; 65,536 lines a face.
    for (Index face = 1; face < 6; ++face) {
        const double expected = face == 1 ? 0.199824895698 : 0.200043776075;
        const double standard_error = std::sqrt(expected * (1 - expected) / 65536);
        EXPECT_NEAR(mean_factor(lined, factors, 0, face), expected, 3 * standard_error) << face;
    }
}

TEST(Rows, AColumnStandsOnceInARow) {
    LinedWorld lined(testing::small_room(), 0.4F, 64);
    const FormFactors factors = factors_of(lined);
    for (std::size_t row = 0; row < factors.matrix.rows(); ++row) {
        std::vector<Index> columns(
            factors.matrix.column.begin() + static_cast<std::ptrdiff_t>(factors.matrix.row_begin[row]),
            factors.matrix.column.begin() + static_cast<std::ptrdiff_t>(factors.matrix.row_begin[row + 1]));
        std::sort(columns.begin(), columns.end());
        EXPECT_EQ(std::adjacent_find(columns.begin(), columns.end()), columns.end());
    }
}

TEST(Rows, BuriedOriginsAreLeftOut) {
    // A floor half of whose patch lies within an actor that reaches through it: only the open half has a say.
    // (Along furniture, which stays, the floor would be cut.)
    World world = testing::empty_world();
    add_quad(world.bodies[furniture], Vec3(0), Vec3(0, 0, 1), Vec3(1, 0, 0), 0);
    Path path;
    path.keys = {{0, {Vec3(0, 0, 0.5F), Quat(1, 0, 0, 0)}}};
    testing::add_actor(world, "block", Vec3(0.5F, 0.5F, 1), 0, path);
    Surfaces surfaces = find_surfaces(world, {.facet_size_m = 0.01F});
    SideMask outsides(surfaces.list.size(), {true, false});
    const PatchMesh mesh = make_patches(world, std::move(surfaces), outsides, {.patch_size_m = 4});
    const RayCaster caster(world);
    const Lamps lamps = find_lamps(world, mesh);
    const SightLines sight(mesh, world, 256, 1);
    const LightLines light(mesh, sight, lamps, 16, 1);
    VisibleLines visible = make_visible_lines(mesh, sight, light);
    const StaticLines none;
    make_retrace()->update({mesh, sight, light, caster, none}, {0, 256}, visible, Context(1));
    const FormFactors factors = compile_rows(mesh, sight, light, lamps, caster,
                                             {visible.patch, 256, visible.light_contribution}, Context(1));
    EXPECT_NEAR(factors.valid_share[0], 0.5F, 0.01F);
    EXPECT_NEAR(row_sum(factors.matrix, 0) + factors.sky[0], 1, 1e-5);
}

TEST(Rows, SameBitsForAnyNumberOfThreads) {
    const LinedWorld lined(testing::small_room(), 0.3F, 64);
    const FormFactors one = factors_of(lined, 1);
    for (const int threads : {2, 4}) {
        const FormFactors many = factors_of(lined, threads);
        EXPECT_EQ(many.matrix.column, one.matrix.column);
        EXPECT_EQ(many.matrix.value, one.matrix.value);
        EXPECT_EQ(many.sky, one.sky);
    }
}

}  // namespace
}  // namespace afterglow
