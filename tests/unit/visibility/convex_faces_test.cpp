#include "solver/visibility/convex_faces.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

std::vector<Index> triangles_of(const std::vector<ConvexFace>& faces) {
    std::vector<Index> found;
    for (const ConvexFace& face : faces) {
        found.push_back(face.triangle);
        if (face.second_triangle != no_index) found.push_back(face.second_triangle);
    }
    std::sort(found.begin(), found.end());
    return found;
}

TEST(ConvexFaces, OfABoxAreItsSixSides) {
    Body body;
    testing::add_box(body, Vec3(-1, 0, 2), Vec3(1, 3, 2.5F), 0);
    const auto faces = convex_faces(body);
    ASSERT_EQ(faces.size(), 6U);
    for (const ConvexFace& face : faces) {
        EXPECT_EQ(face.count, 4U);
        // Front outwards, as the triangles had it.
        EXPECT_GT(glm::dot(face.normal, face.corners[0] - Vec3(0, 1.5F, 2.25F)), 0);
    }
    EXPECT_THAT(triangles_of(faces), ::testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11));
}

TEST(ConvexFaces, KnowTheTriangleOfAPoint) {
    Body body;
    testing::add_box(body, Vec3(-1, 0, 2), Vec3(1, 3, 2.5F), 0);
    for (const ConvexFace& face : convex_faces(body)) {
        for (const Index t : {face.triangle, face.second_triangle}) {
            const auto& v = body.triangles[t].vertices;
            const Vec3 middle = (body.positions[v[0]] + body.positions[v[1]] + body.positions[v[2]]) / 3.0F;
            EXPECT_EQ(face.triangle_at(middle), t);
        }
    }
}

TEST(ConvexFaces, OfABallAreItsTriangles) {
    Body body;
    testing::add_ball(body, Vec3(1, 2, 3), 0.7F, 2, 0);
    const auto faces = convex_faces(body);
    EXPECT_EQ(faces.size(), body.triangles.size());
    for (const ConvexFace& face : faces) EXPECT_EQ(face.count, 3U);
}

/// Two triangles on a common edge from (0,0,0) to (0,1,0).
Body pair_of_triangles(const Vec3& right, const Vec3& left) {
    Body body;
    testing::add_triangle(body, Vec3(0), right, Vec3(0, 1, 0), 0);
    testing::add_triangle(body, Vec3(0), Vec3(0, 1, 0), left, 0);
    return body;
}

TEST(ConvexFaces, AreJoinedOnlyWhereFlatAndConvex) {
    EXPECT_EQ(convex_faces(pair_of_triangles(Vec3(1, 0.5F, 0), Vec3(-1, 0.5F, 0))).size(), 1U);
    // Bent along the edge, folded onto each other, turned inwards, straight at an end of the edge.
    EXPECT_EQ(convex_faces(pair_of_triangles(Vec3(1, 0.5F, 0), Vec3(-1, 0.5F, 0.01F))).size(), 2U);
    EXPECT_EQ(convex_faces(pair_of_triangles(Vec3(1, 0.5F, 0), Vec3(0.5F, 0.5F, 0))).size(), 2U);
    EXPECT_EQ(convex_faces(pair_of_triangles(Vec3(1, 1.5F, 0), Vec3(-1, 1.5F, 0))).size(), 2U);
    EXPECT_EQ(convex_faces(pair_of_triangles(Vec3(1, 0, 0), Vec3(-1, 0, 0))).size(), 2U);
}

TEST(ConvexFaces, OfTrianglesWithoutAreaStayApart) {
    EXPECT_EQ(convex_faces(pair_of_triangles(Vec3(0, 0.5F, 0), Vec3(-1, 0.5F, 0))).size(), 2U);
    EXPECT_TRUE(convex_faces(Body{}).empty());
}

}  // namespace
}  // namespace afterglow
