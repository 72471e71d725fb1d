#include "solver/mesh/surface.h"

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::add_ball;
using testing::add_box;
using testing::add_quad;
using testing::empty_world;

TEST(Surfaces, ABoxHasSixFlatOnes) {
    World world = empty_world();
    add_box(world.bodies[furniture], Vec3(0), Vec3(1, 2, 3), 0);
    const Surfaces surfaces = find_surfaces(world);
    ASSERT_EQ(surfaces.list.size(), 6U);
    float area = 0;
    for (const Surface& s : surfaces.list) {
        EXPECT_EQ(s.kind, Surface::Kind::flat);
        EXPECT_EQ(s.triangles.size(), 2U);
        area += s.area_m2;
    }
    EXPECT_NEAR(area, 2 * (2 + 3 + 6), 1e-5);
}

TEST(Surfaces, ADenseBallIsOneCurvedSurface) {
    World world = empty_world();
    add_ball(world.bodies[furniture], Vec3(0), 1, 3, 0);
    const Surfaces surfaces = find_surfaces(world, {.facet_size_m = 0.5F});
    ASSERT_EQ(surfaces.list.size(), 1U);
    EXPECT_EQ(surfaces.list[0].kind, Surface::Kind::curved);
    EXPECT_NEAR(surfaces.list[0].area_m2, 4 * pi, 0.1);
}

TEST(Surfaces, MaterialsAndGapsSeparate) {
    World world = empty_world();
    add_quad(world.bodies[furniture], Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0), 0);
    add_quad(world.bodies[furniture], Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), 1);
    add_quad(world.bodies[furniture], Vec3(3, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), 0);
    EXPECT_EQ(find_surfaces(world).list.size(), 3U);
}

TEST(Surfaces, EveryTriangleBelongsToTheSurfaceThatListsIt) {
    World world = testing::small_room();
    add_ball(world.bodies[furniture], Vec3(3, 0.5F, 4), 0.3F, 2, 0);
    const Surfaces surfaces = find_surfaces(world, {.facet_size_m = 0.2F});
    std::size_t listed = 0, triangles = 0;
    for (Index s = 0; s < surfaces.list.size(); ++s)
        for (const Index t : surfaces.list[s].triangles) {
            EXPECT_EQ(surfaces.of_triangle[surfaces.list[s].body][t], s);
            ++listed;
        }
    for (const Body& body : world.bodies) triangles += body.triangles.size();
    EXPECT_EQ(listed, triangles);
}

}  // namespace
}  // namespace afterglow
