#include "solver/visibility/triangle_tree.h"

#include <algorithm>
#include <numeric>

#include "solver/visibility/closed_body.h"

namespace afterglow {

namespace {

// Looking at a box costs about as much as looking at a triangle.
constexpr Index triangles_of_leaf = 4;

// Boxes are a little too large, so that rounding never hides a face that a line just touches.
constexpr float margin = 1e-6F;

class Builder {
  public:
    explicit Builder(const Body& body) : tree_(), boxes_(body.triangles.size()) {
        for (std::size_t t = 0; t < boxes_.size(); ++t)
            for (const Index v : body.triangles[t].vertices) boxes_[t].add(body.positions[v]);
        tree_.order.resize(boxes_.size());
        std::iota(tree_.order.begin(), tree_.order.end(), Index{0});
    }

    TriangleTree build() {
        if (boxes_.empty()) return std::move(tree_);
        tree_.nodes.emplace_back();
        fill(0, 0, static_cast<Index>(boxes_.size()));
        return std::move(tree_);
    }

  private:
    void fill(std::size_t node, Index first, Index count) {
        Box box, centres;
        for (Index k = first; k < first + count; ++k) {
            box.add(boxes_[tree_.order[k]]);
            centres.add(boxes_[tree_.order[k]].centre());
        }
        const Vec3 largest = glm::max(glm::abs(box.low), glm::abs(box.high));
        tree_.nodes[node] = {box.centre(), 0.5F * box.extent() + margin * largest, first, count};
        if (count <= triangles_of_leaf) return;
        const Vec3 extent = centres.extent();
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const auto begin = tree_.order.begin() + first;
        const Index half = count / 2;
        // Equal places keep the order of the file, so that the tree is the same everywhere.
        std::nth_element(begin, begin + half, begin + count, [&](Index a, Index b) {
            const float at_a = boxes_[a].centre()[axis], at_b = boxes_[b].centre()[axis];
            return at_a != at_b ? at_a < at_b : a < b;
        });
        const auto children = static_cast<Index>(tree_.nodes.size());
        tree_.nodes.resize(children + 2);
        tree_.nodes[node].first = children;
        tree_.nodes[node].count = 0;
        fill(children, first, half);
        fill(children + 1, first + half, count - half);
    }

    TriangleTree tree_;
    std::vector<Box> boxes_;
};

}  // namespace

TriangleTree make_triangle_tree(const Body& body) {
    TriangleTree tree = Builder(body).build();
    tree.closed = is_closed_outwards(body);
    return tree;
}

}  // namespace afterglow
