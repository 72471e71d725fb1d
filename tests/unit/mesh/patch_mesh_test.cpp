#include "solver/mesh/patch_mesh.h"

#include <numeric>
#include <random>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::add_ball;
using testing::add_box;
using testing::add_quad;
using testing::empty_world;

SideMask both_sides(const Surfaces& surfaces) {
    return SideMask(surfaces.list.size(), {true, true});
}

PatchMesh mesh_of(const World& world, float size) {
    Surfaces surfaces = find_surfaces(world, {.facet_size_m = size});
    const SideMask mask = both_sides(surfaces);
    return make_patches(world, std::move(surfaces), mask, {.patch_size_m = size});
}

/// Flat, clipped and curved surfaces, furniture and an actor.
World mixed_world() {
    World world = testing::small_room();
    Body& body = world.bodies[furniture];
    add_ball(body, Vec3(3, 0.5F, 4), 0.3F, 3, 0);
    // A lone slanted triangle, so that grid cells are cut in every way.
    const auto first = static_cast<Index>(body.positions.size());
    for (const Vec3& p : {Vec3(0.2F, 0.3F, 4.1F), Vec3(1.7F, 0.9F, 4.3F), Vec3(0.6F, 1.8F, 3.7F)}) {
        body.positions.push_back(p);
        body.texture_coordinates.emplace_back(0);
    }
    body.triangles.push_back({{first, first + 1, first + 2}, 0});
    return world;
}

TEST(PatchMesh, PatchAreasAddUpToTheSurfaces) {
    const PatchMesh mesh = mesh_of(mixed_world(), 0.17F);
    std::vector<double> area(mesh.surfaces.list.size());
    for (Index p = 0; p < mesh.size(); ++p) area[mesh.surface[p]] += mesh.area_m2[p];
    for (std::size_t s = 0; s < area.size(); ++s)
        EXPECT_NEAR(area[s], 2 * mesh.surfaces.list[s].area_m2, 2e-4 * area[s]);
}

TEST(PatchMesh, PointsOfAPatchLeadBackToIt) {
    const World world = mixed_world();
    const PatchMesh mesh = mesh_of(world, 0.17F);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.001F, 0.999F);
    std::size_t tried = 0, found = 0;
    for (Index p = 0; p < mesh.size(); ++p) {
        const PatchPoint point = mesh.point_on(p, unit(random), unit(random));
        const Surface& surface = mesh.surfaces.list[mesh.surface[p]];
        // The triangle that holds the point: the one whose barycentric coordinates are least negative.
        float best = -1;
        Index triangle = no_index;
        for (const Index t : surface.triangles) {
            const Body& body = world.bodies[surface.body];
            const auto& v = body.triangles[t].vertices;
            const Vec3 a = body.positions[v[0]], n = doubled_area_normal(body, t);
            const Vec3 b = body.positions[v[1]], c = body.positions[v[2]];
            const float nn = glm::dot(n, n);
            const float beta = glm::dot(glm::cross(point.position - a, c - a), n) / nn;
            const float gamma = glm::dot(glm::cross(b - a, point.position - a), n) / nn;
            const float off = std::abs(glm::dot(point.position - a, n)) / nn;
            const float inside = std::min({1 - beta - gamma, beta, gamma}) - off;
            if (triangle == no_index || inside > best) {
                best = inside;
                triangle = t;
            }
        }
        ++tried;
        if (mesh.patch_at(surface.body, triangle, mesh.side[p], point.position) == p) ++found;
    }
    // Points within rounding of a cell's border may go to its neighbour.
    EXPECT_GE(found, tried - tried / 500);
}

TEST(PatchMesh, CellsAreNoLargerThanAskedFor) {
    World world = empty_world();
    add_quad(world.bodies[furniture], Vec3(0), Vec3(3, 0, 0), Vec3(0, 2, 0), 0);
    const PatchMesh mesh = mesh_of(world, 0.5F);
    EXPECT_EQ(mesh.size(), 2U * 6U * 4U);
    for (Index p = 0; p < mesh.size(); ++p) EXPECT_NEAR(mesh.area_m2[p], 0.25F, 1e-6);
}

TEST(PatchMesh, PatchCountFollowsAreaNotTriangles) {
    World coarse = empty_world(), fine = empty_world();
    add_ball(coarse.bodies[furniture], Vec3(0), 1, 3, 0);
    add_ball(fine.bodies[furniture], Vec3(0), 1, 5, 0);
    const auto a = mesh_of(coarse, 0.4F).size(), b = mesh_of(fine, 0.4F).size();
    EXPECT_LT(b, 2 * a);
    EXPECT_GT(b, a / 2);
}

TEST(PatchMesh, SidesThatAreNotWantedHaveNoPatches) {
    World world = empty_world();
    add_box(world.bodies[furniture], Vec3(0), Vec3(1), 0);
    Surfaces surfaces = find_surfaces(world);
    const SideMask fronts(surfaces.list.size(), {true, false});
    const PatchMesh mesh = make_patches(world, std::move(surfaces), fronts, {.patch_size_m = 0.5F});
    EXPECT_EQ(mesh.size(), 24U);
    EXPECT_EQ(mesh.patch_at(furniture, 0, Side::back, world.bodies[furniture].positions[0]), no_index);
    EXPECT_NE(mesh.patch_at(furniture, 0, Side::front, world.bodies[furniture].positions[0]), no_index);
}

TEST(PatchMesh, ActorsFollowTheFurniture) {
    const PatchMesh mesh = mesh_of(testing::small_room(), 0.3F);
    ASSERT_EQ(mesh.first_patch_of_body.size(), 3U);
    EXPECT_GT(mesh.static_size(), 0U);
    for (Index p = 0; p < mesh.size(); ++p) EXPECT_EQ(mesh.body[p], p < mesh.static_size() ? 0U : 1U);
    EXPECT_EQ(mesh.first_patch_of_body.back(), mesh.size());
}

TEST(PatchMesh, TooSmallPatchesAreRefusedByName) {
    try {
        mesh_of(testing::small_room(), 1e-4F);
        FAIL() << "must throw";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::too_large);
        EXPECT_EQ(error.place(), "patch_size");
    }
}

}  // namespace
}  // namespace afterglow
