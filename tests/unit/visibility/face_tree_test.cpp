#include "solver/visibility/face_tree.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

TEST(FaceTree, HoldsEveryFaceOnceWithinItsBoxes) {
    for (const int levels : {0, 1, 3}) {
        Body body;
        testing::add_ball(body, Vec3(1, 2, 3), 0.7F, levels, 0);
        const FaceTree tree = make_face_tree(body);
        std::vector<Index> found;
        std::vector<Index> waiting{0};
        while (!waiting.empty()) {
            const FaceTree::Node& node = tree.nodes[waiting.back()];
            waiting.pop_back();
            if (node.count == 0) waiting.insert(waiting.end(), {node.first, node.first + 1});
            for (Index k = node.first; k < node.first + node.count; ++k) {
                const ConvexFace& face = tree.faces[k];
                found.push_back(face.triangle);
                if (face.second_triangle != no_index) found.push_back(face.second_triangle);
                for (Index c = 0; c < face.count; ++c) {
                    const Vec3 off = glm::abs(face.corners[c] - node.centre) - node.half;
                    EXPECT_LE(std::max({off.x, off.y, off.z}), 1e-6F);
                }
            }
        }
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found.size(), body.triangles.size());
        for (Index t = 0; t < found.size(); ++t) EXPECT_EQ(found[t], t);
    }
}

TEST(FaceTree, OfNothingIsEmpty) {
    EXPECT_TRUE(make_face_tree(Body{}).nodes.empty());
}

TEST(FaceTree, OfFacesAtOnePlaceEnds) {
    Body body;
    body.positions = {Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    body.triangles.assign(1000, Triangle{{0, 1, 2}, 0});
    const FaceTree tree = make_face_tree(body);
    EXPECT_EQ(tree.faces.size(), 1000U);
}

}  // namespace
}  // namespace afterglow
