#include "solver/visibility/face_tree.h"

#include <algorithm>
#include <utility>

#include "solver/visibility/closed_body.h"

namespace afterglow {

namespace {

// Looking at a box costs about as much as looking at a face.
constexpr Index faces_of_leaf = 4;

// Boxes are a little too large, so that rounding never hides a face that a line just touches.
constexpr float margin = 1e-6F;

Box box_of(const ConvexFace& face) {
    Box box;
    for (Index k = 0; k < face.count; ++k) box.add(face.corners[k]);
    return box;
}

class Builder {
  public:
    explicit Builder(const Body& body) {
        tree_.faces = convex_faces(body);
        tree_.closed = is_closed_outwards(body);
        if (tree_.faces.empty()) return;
        tree_.nodes.emplace_back();
        fill(0, 0, static_cast<Index>(tree_.faces.size()));
    }
    FaceTree result() { return std::move(tree_); }

  private:
    void fill(std::size_t node, Index first, Index count) {
        Box box, centres;
        for (Index k = first; k < first + count; ++k) {
            const Box of_face = box_of(tree_.faces[k]);
            box.add(of_face);
            centres.add(of_face.centre());
        }
        const Vec3 largest = glm::max(glm::abs(box.low), glm::abs(box.high));
        tree_.nodes[node] = {box.centre(), 0.5F * box.extent() + margin * largest, first, count};
        if (count <= faces_of_leaf) return;
        const Vec3 extent = centres.extent();
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const auto begin = tree_.faces.begin() + first;
        const Index half = count / 2;
        // Equal places keep the order of the file, so that the tree is the same everywhere.
        std::nth_element(begin, begin + half, begin + count, [&](const ConvexFace& a, const ConvexFace& b) {
            const float at_a = box_of(a).centre()[axis], at_b = box_of(b).centre()[axis];
            return at_a != at_b ? at_a < at_b : a.triangle < b.triangle;
        });
        const auto children = static_cast<Index>(tree_.nodes.size());
        tree_.nodes.resize(children + 2);
        tree_.nodes[node].first = children;
        tree_.nodes[node].count = 0;
        fill(children, first, half);
        fill(children + 1, first + half, count - half);
    }

    FaceTree tree_;
};

}  // namespace

FaceTree make_face_tree(const Body& body) {
    return Builder(body).result();
}

}  // namespace afterglow
