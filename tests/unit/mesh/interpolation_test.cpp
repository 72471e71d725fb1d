#include "solver/mesh/interpolation.h"

#include <numeric>

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::add_ball;
using testing::add_quad;
using testing::empty_world;

struct Interpolated {
    World world;
    PatchMesh mesh;

    explicit Interpolated(World w, float size) : world(std::move(w)) {
        Surfaces surfaces = find_surfaces(world, {.facet_size_m = size});
        const SideMask mask(surfaces.list.size(), {true, false});
        mesh = make_patches(world, std::move(surfaces), mask, {.patch_size_m = size});
    }
    [[nodiscard]] float at(const std::vector<Rgb>& values, Index triangle, const Vec3& p) const {
        const std::vector<float> sure(values.size(), 1);
        return Interpolation::value(Interpolation(world, mesh).at(furniture, triangle, Side::front, p),
                                    values, sure)
            .x;
    }
};

World square() {
    World world = empty_world();
    add_quad(world.bodies[furniture], Vec3(0), Vec3(2, 0, 0), Vec3(0, 2, 0), 0);
    return world;
}

TEST(Interpolation, ALinearFieldIsReproducedBetweenCellCentres) {
    const Interpolated it(square(), 0.25F);
    std::vector<Rgb> values;
    for (Index p = 0; p < it.mesh.size(); ++p)
        values.emplace_back(1 + 2 * it.mesh.centre[p].x - 3 * it.mesh.centre[p].y);
    for (const Vec3 p : {Vec3(0.31F, 0.2F, 0), Vec3(1.7F, 1.1F, 0), Vec3(1, 0.99F, 0)})
        EXPECT_NEAR(it.at(values, p.x > p.y ? 0 : 1, p), 1 + 2 * p.x - 3 * p.y, 1e-5);
}

TEST(Interpolation, WeightsAreAPartitionOfUnityEverywhere) {
    World world = square();
    add_ball(world.bodies[furniture], Vec3(5, 0, 0), 1, 3, 0);
    const Interpolated it(std::move(world), 0.3F);
    const Interpolation interpolation(it.world, it.mesh);
    const Body& body = it.world.bodies[furniture];
    for (Index t = 0; t < body.triangles.size(); ++t) {
        for (const Index v : body.triangles[t].vertices) {
            const Stencil stencil = interpolation.at(furniture, t, Side::front, body.positions[v]);
            ASSERT_GT(stencil.count, 0U);
            float sum = 0;
            for (const PatchWeight& entry : stencil.patches()) {
                EXPECT_GE(entry.weight, 0);
                sum += entry.weight;
            }
            EXPECT_NEAR(sum, 1, 1e-5);
        }
    }
}

TEST(Interpolation, PatchesThatKnowNothingHaveNoSay) {
    const Interpolated it(square(), 1);
    ASSERT_EQ(it.mesh.size(), 4U);
    std::vector<Rgb> values(4, Rgb(2));
    values[0] = Rgb(100);
    std::vector<float> sure(4, 1);
    sure[0] = 0;
    const Stencil stencil = Interpolation(it.world, it.mesh).at(furniture, 0, Side::front, Vec3(1, 1, 0));
    EXPECT_NEAR(Interpolation::value(stencil, values, sure).x, 2, 1e-6);
}

TEST(Interpolation, SidesWithoutPatchesGiveNothing) {
    const Interpolated it(square(), 1);
    EXPECT_EQ(Interpolation(it.world, it.mesh).at(furniture, 0, Side::back, Vec3(1, 1, 0)).count, 0U);
}

}  // namespace
}  // namespace afterglow
