#include "solver/visibility/bsp_tree.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/support/actors.h"

namespace afterglow {
namespace {

/// Every face below a node is on its side of the node's plane, and ranges of faces add up.
void expect_sound(const BspTree& tree, const Body& body, Index index) {
    const BspTree::Node& node = tree.nodes[index];
    Index next = node.first_face + node.own_faces;
    const auto side = [&](Index child, bool in_front) {
        if (child == no_index) return;
        ASSERT_GT(child, index);
        ASSERT_EQ(tree.nodes[child].first_face, next);
        next += tree.nodes[child].subtree_faces;
        for (Index f = tree.nodes[child].first_face; f < next; ++f) {
            const BspTree::Face& face = tree.faces[f];
            bool split_here = false;
            for (Index s = face.first_split; s < face.first_split + face.splits; ++s)
                if (tree.split_list[s].node == index) {
                    split_here = true;
                    EXPECT_EQ(tree.split_list[s].in_front, in_front);
                }
            if (split_here) continue;
            // A face split above is smaller than its triangle: then the triangle says nothing.
            if (face.splits > 0) continue;
            for (const Index vertex : body.triangles[face.triangle].vertices) {
                const double above = node.plane.above(Vec3d(body.positions[vertex]));
                EXPECT_GE(in_front ? above : -above, -1e-5);
            }
        }
        expect_sound(tree, body, child);
    };
    side(node.front, true);
    side(node.back, false);
    EXPECT_EQ(next, node.first_face + node.subtree_faces);
}

/// Every point of every triangle is held by exactly one face.
void expect_covered(const BspTree& tree, const Body& body) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    for (Index t = 0; t < body.triangles.size(); ++t) {
        const auto& v = body.triangles[t].vertices;
        const Vec3d a(body.positions[v[0]]), b(body.positions[v[1]]), c(body.positions[v[2]]);
        if (glm::length(glm::cross(b - a, c - a)) == 0) continue;
        for (int k = 0; k < 20; ++k) {
            const double s = unit(random), r = unit(random) * (1 - s);
            const Vec3d point = a + s * (b - a) + r * (c - a);
            int holders = 0;
            for (const BspTree::Face& face : tree.faces)
                holders += face.triangle == t && tree.holds(face, point) ? 1 : 0;
            ASSERT_EQ(holders, 1) << "triangle " << t;
        }
    }
}

TEST(BspTree, OfABoxHasAllFacesAndSplitsNone) {
    Body body;
    testing::add_box(body, Vec3(-1), Vec3(1), 0);
    const BspTree tree = make_bsp_tree(body);
    EXPECT_EQ(tree.faces.size(), 12U);
    EXPECT_EQ(tree.nodes.size(), 6U);
    expect_sound(tree, body, 0);
    expect_covered(tree, body);
}

TEST(BspTree, OfARingSplitsAndCoversAll) {
    Body body;
    testing::add_ring(body, Vec3(0), 1, 0.2F, 0);
    const BspTree tree = make_bsp_tree(body);
    EXPECT_GT(tree.faces.size(), body.triangles.size());
    expect_sound(tree, body, 0);
    expect_covered(tree, body);
}

TEST(BspTree, OfABallIsShallow) {
    Body body;
    testing::add_ball(body, Vec3(0.3F), 1, 3, 0);
    const BspTree tree = make_bsp_tree(body);
    expect_sound(tree, body, 0);
    std::vector<int> depth(tree.nodes.size(), 1);
    int deepest = 0;
    for (Index n = 0; n < tree.nodes.size(); ++n) {
        deepest = std::max(deepest, depth[n]);
        for (const Index child : {tree.nodes[n].front, tree.nodes[n].back})
            if (child != no_index) depth[child] = depth[n] + 1;
    }
    EXPECT_LT(deepest, 64);
    EXPECT_LT(tree.faces.size(), 2 * body.triangles.size());
}

TEST(BspTree, CoincidentFacesShareANodeAndDegenerateOnesAreLeftOut) {
    Body body;
    testing::add_quad(body, Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0), 0);
    testing::add_quad(body, Vec3(0.25F, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0), 0);
    body.positions.insert(body.positions.end(), {Vec3(0), Vec3(1), Vec3(2)});
    body.triangles.push_back({{8, 9, 10}, 0});
    body.triangles.push_back({{0, 0, 1}, 0});
    const BspTree tree = make_bsp_tree(body);
    ASSERT_EQ(tree.nodes.size(), 1U);
    EXPECT_EQ(tree.nodes[0].own_faces, 4U);
    EXPECT_TRUE(make_bsp_tree(Body{}).nodes.empty());
}

TEST(BspTree, ThatWouldGrowTooDeepOrLargeKeepsTheRestTogether) {
    Body body;
    testing::add_ball(body, Vec3(0), 1, 2, 0);
    const BspTree shallow = make_bsp_tree(body, {.most_depth = 2});
    EXPECT_LE(shallow.nodes.size(), 7U);
    expect_covered(shallow, body);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1, 1);
    Body crossing;
    for (Index k = 0; k < 60; ++k) {
        for (int corner = 0; corner < 3; ++corner)
            crossing.positions.emplace_back(unit(random), unit(random), unit(random));
        crossing.triangles.push_back({{3 * k, 3 * k + 1, 3 * k + 2}, 0});
    }
    const BspTree limited = make_bsp_tree(crossing, {.most_growth = 1});
    EXPECT_LT(limited.faces.size(), make_bsp_tree(crossing).faces.size());
    expect_covered(limited, crossing);
}

}  // namespace
}  // namespace afterglow
