#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "solver/base/math.h"

namespace afterglow {

/// Finds the boxes that overlap a box, among many. Built by halving at the median of the longest axis: as
/// good for rooms of large walls as for heaps of small things. Cost: O(n log n) to build. Thread-safety:
/// const after construction.
class BoxTree {
  public:
    explicit BoxTree(std::vector<Box> boxes);

    /// Calls `visit(index)` for every box that overlaps or touches `region`, in a fixed order.
    template <class Visit>
    void for_overlaps(const Box& region, const Visit& visit) const {
        // Halving 2³² boxes never goes deeper; each level leaves one node behind.
        std::array<Index, 40> stack{};
        std::size_t count = 0;
        if (!nodes_.empty()) stack[count++] = 0;
        while (count > 0) {
            const Node& node = nodes_[stack[--count]];
            if (!node.box.meets(region)) continue;
            if (node.right != no_index) {
                stack[count++] = node.right;
                stack[count++] = static_cast<Index>(&node - nodes_.data()) + 1;
                continue;
            }
            for (Index i = node.first; i < node.last; ++i)
                if (boxes_[order_[i]].meets(region)) visit(order_[i]);
        }
    }

  private:
    struct Node {
        Box box;
        Index first = 0, last = 0;  ///< of a leaf: where in order_
        Index right = no_index;     ///< of an inner node; the left one follows its parent
    };

    void build(Index first, Index last);

    std::vector<Box> boxes_;
    std::vector<Index> order_;
    std::vector<Node> nodes_;
};

}  // namespace afterglow
