#include <atomic>

#include <gmock/gmock.h>

#include "solver/mesh/interpolation.h"
#include "solver/mesh/patch_mesh.h"
#include "tests/support/worlds.h"

// Meshes whose cells are halved where a test asks for it.

namespace afterglow {
namespace {

using testing::add_quad;
using testing::empty_world;

constexpr float finest = 0.05F;

/// Everything within 0.3 m of a place on the floor must be fine.
struct NearAPlace {
    Vec3 place;
    bool operator()(const PatchShape& part, Index, Side) const {
        const float edge = std::max(glm::length(part.edge_u), glm::length(part.edge_v));
        return glm::length(part.centre - place) < 0.3F + edge;
    }
};

PatchMesh refined(const World& world, const CoarsenessTest& test, const Context& context = Context(1)) {
    Surfaces surfaces = find_surfaces(world, {.facet_size_m = 0.4F});
    const SideMask all(surfaces.list.size(), {true, true});
    return make_patches(world, std::move(surfaces), all, {0.4F, 0.99F * finest, test}, context);
}

/// A square of 4 m with a triangle beside it, so that cells are cut too.
World floor_world() {
    World world = empty_world();
    Body& body = world.bodies[furniture];
    add_quad(body, Vec3(0), Vec3(4, 0, 0), Vec3(0, 4, 0), 0);
    const auto first = static_cast<Index>(body.positions.size());
    for (const Vec3& p : {Vec3(4, 0, 0), Vec3(6, 0, 0), Vec3(4, 3, 0)}) {
        body.positions.push_back(p);
        body.texture_coordinates.emplace_back(0);
    }
    body.triangles.push_back({{first, first + 1, first + 2}, 0});
    return world;
}

TEST(Refinement, IsFineWhereAskedAndCoarseElsewhere) {
    const Vec3 place(1.3F, 2.2F, 0);
    const PatchMesh mesh = refined(floor_world(), NearAPlace{place});
    Index fine = 0, coarse = 0;
    for (Index p = 0; p < mesh.size(); ++p) {
        const float distance = glm::length(mesh.centre[p] - place);
        if (distance < 0.25F) {
            EXPECT_LE(glm::length(mesh.edge_u[p]), finest * 1.001F);
        }
        if (glm::length(mesh.edge_u[p]) < 2 * finest)
            ++fine;
        else
            ++coarse;
    }
    EXPECT_GT(fine, 100U);
    EXPECT_GT(coarse, 100U);
    EXPECT_LT(mesh.size(), 1500U) << "an even mesh as fine would have 17,600";
}

TEST(Refinement, PatchesStillCoverTheirSurfaces) {
    const PatchMesh mesh = refined(floor_world(), NearAPlace{Vec3(4, 1.1F, 0)});
    std::vector<double> area(mesh.surfaces.list.size());
    for (Index p = 0; p < mesh.size(); ++p) area[mesh.surface[p]] += mesh.area_m2[p];
    for (std::size_t s = 0; s < area.size(); ++s)
        EXPECT_NEAR(area[s], 2 * mesh.surfaces.list[s].area_m2, 2e-4 * area[s]);
}

TEST(Refinement, PointsOfAPatchLeadBackToIt) {
    const PatchMesh mesh = refined(floor_world(), NearAPlace{Vec3(1, 1, 0)});
    std::size_t lost = 0;
    for (Index p = 0; p < mesh.size(); ++p) {
        const Vec3 at = mesh.point_on(p, 0.37F, 0.61F).position;
        // Triangle 0 or 1 of the square or the triangle beside it: all lie in one plane, a surface each.
        const Index triangle = mesh.surfaces.list[mesh.surface[p]].triangles.front();
        if (mesh.patch_at(furniture, triangle, mesh.side[p], at) != p) ++lost;
    }
    EXPECT_LE(lost, mesh.size() / 500);
}

TEST(Refinement, NeighboursDifferByOneHalving) {
    const PatchMesh mesh = refined(floor_world(), NearAPlace{Vec3(1.3F, 2.2F, 0)});
    for (Index p = 0; p < mesh.size(); ++p) {
        const Index triangle = mesh.surfaces.list[mesh.surface[p]].triangles.front();
        const Vec3 middle = mesh.origin[p] + 0.5F * (mesh.edge_u[p] + mesh.edge_v[p]);
        for (const auto& [du, dv] : {std::pair(1, 0), {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}}) {
            const Vec3 beside =
                middle + static_cast<float>(du) * mesh.edge_u[p] + static_cast<float>(dv) * mesh.edge_v[p];
            const Index q = mesh.patch_at(furniture, triangle, mesh.side[p], beside);
            if (q == no_index) continue;
            EXPECT_LE(glm::length(mesh.edge_u[q]), 2.001F * glm::length(mesh.edge_u[p]));
        }
    }
}

TEST(Refinement, InterpolationStaysWithinTheValuesAround) {
    const World world = floor_world();
    const PatchMesh mesh = refined(world, NearAPlace{Vec3(1.3F, 2.2F, 0)});
    const Interpolation interpolation(world, mesh);
    std::vector<Rgb> values;
    for (Index p = 0; p < mesh.size(); ++p) values.emplace_back(mesh.centre[p].x);
    const std::vector<float> sure(values.size(), 1);
    for (int i = 1; i < 200; ++i) {
        const Vec3 at(0.02F * static_cast<float>(i), 2.21F, 0);
        const Stencil stencil = interpolation.at(furniture, at.x > at.y ? 0 : 1, Side::front, at);
        EXPECT_LT(stencil.count, Stencil::most) << "some neighbours may have been left out";
        // Of a linear field it gives the value at the window's middle, off by half a cell at most.
        EXPECT_NEAR(Interpolation::value(stencil, values, sure).x, at.x, 0.2F);
    }
}

TEST(Refinement, IsTheSameForAnyNumberOfThreads) {
    const World world = testing::small_room();
    const NearAPlace test{Vec3(1, 0, 1)};
    const PatchMesh one = refined(world, test), two = refined(world, test, Context(2));
    EXPECT_EQ(one.centre, two.centre);
    EXPECT_EQ(one.area_m2, two.area_m2);
}

}  // namespace
}  // namespace afterglow
