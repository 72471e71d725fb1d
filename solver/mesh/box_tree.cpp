#include "solver/mesh/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace afterglow {

namespace {

constexpr Index boxes_per_leaf = 4;

}  // namespace

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), Index{0});
    if (!boxes_.empty()) build(0, static_cast<Index>(boxes_.size()));
}

void BoxTree::build(Index first, Index last) {
    const std::size_t number = nodes_.size();
    nodes_.push_back({{}, first, last, no_index});
    Box centres;
    for (Index i = first; i < last; ++i) {
        nodes_[number].box.add(boxes_[order_[i]]);
        centres.add(boxes_[order_[i]].centre());
    }
    if (last - first <= boxes_per_leaf) return;
    const Vec3 extent = centres.extent();
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const Index middle = first + (last - first) / 2;
    const auto at = [&](Index i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    // By number where centres agree, so that the order is the same everywhere.
    std::nth_element(at(first), at(middle), at(last), [&](Index a, Index b) {
        return std::pair(boxes_[a].centre()[axis], a) < std::pair(boxes_[b].centre()[axis], b);
    });
    build(first, middle);
    nodes_[number].right = static_cast<Index>(nodes_.size());
    build(middle, last);
}

}  // namespace afterglow
