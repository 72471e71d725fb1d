#include "solver/mesh/smooth_normals.h"

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

using testing::add_ball;
using testing::add_box;
using testing::empty_world;

TEST(SmoothNormals, PointAwayFromTheMiddleOfABall) {
    World world = empty_world();
    add_ball(world.bodies[furniture], Vec3(1, 2, 3), 1, 3, 0);
    const SmoothNormals normals(world, find_surfaces(world, {.facet_size_m = 0.5F}));
    const Body& body = world.bodies[furniture];
    for (Index t = 0; t < body.triangles.size(); ++t) {
        for (const Vec2 uv : {Vec2(0.2F, 0.3F), Vec2(0, 0), Vec2(0.5F, 0.5F)}) {
            const auto& v = body.triangles[t].vertices;
            const Vec3 at = (1 - uv.x - uv.y) * body.positions[v[0]] + uv.x * body.positions[v[1]] +
                            uv.y * body.positions[v[2]];
            // Facets of this ball are off by up to 0.09; their means at vertices by far less.
            EXPECT_LT(glm::length(normals.at(furniture, t, uv.x, uv.y) - glm::normalize(at - Vec3(1, 2, 3))),
                      0.012F);
        }
    }
}

TEST(SmoothNormals, AreContinuousAcrossEdges) {
    World world = empty_world();
    add_ball(world.bodies[furniture], Vec3(0), 1, 2, 0);
    const SmoothNormals normals(world, find_surfaces(world, {.facet_size_m = 0.7F}));
    const Body& body = world.bodies[furniture];
    // At a shared vertex all triangles agree.
    for (Index t = 0; t < body.triangles.size(); ++t) {
        for (Index s = 0; s < body.triangles.size(); ++s) {
            if (body.positions[body.triangles[t].vertices[0]] !=
                body.positions[body.triangles[s].vertices[1]])
                continue;
            EXPECT_LT(glm::length(normals.at(furniture, t, 0, 0) - normals.at(furniture, s, 1, 0)), 1e-5F);
        }
    }
}

TEST(SmoothNormals, OnABoxAreThoseOfItsFaces) {
    World world = empty_world();
    add_box(world.bodies[furniture], Vec3(0), Vec3(1), 0);
    const SmoothNormals normals(world, find_surfaces(world));
    const Body& body = world.bodies[furniture];
    for (Index t = 0; t < body.triangles.size(); ++t)
        EXPECT_EQ(normals.at(furniture, t, 0.3F, 0.3F), glm::normalize(doubled_area_normal(body, t)));
}

}  // namespace
}  // namespace afterglow
