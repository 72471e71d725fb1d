#include "solver/visibility/depth_levels.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace afterglow {

namespace {

/// Tarjan's algorithm over some nodes that no edge leaves, without recursion (chains may be long).
/// Components come out successors first.
class Components {
  public:
    explicit Components(const Successors& successors)
        : successors_(successors), number_(successors.size(), no_index), low_(successors.size()) {}

    void visit(Index root) {
        if (number_[root] != no_index) return;
        enter(root);
        while (!calls_.empty()) {
            Call& call = calls_.back();
            const Index node = call.node;
            if (call.next < successors_[node].size()) {
                const Index to = successors_[node][call.next++];
                if (number_[to] == no_index)
                    enter(to);
                else if (number_[to] != done)
                    low_[node] = std::min(low_[node], number_[to]);
                continue;
            }
            calls_.pop_back();
            if (!calls_.empty()) low_[calls_.back().node] = std::min(low_[calls_.back().node], low_[node]);
            if (low_[node] == number_[node]) close(node);
        }
    }

    std::vector<std::vector<Index>> found;

  private:
    struct Call {
        Index node;
        std::size_t next;
    };
    static constexpr Index done = no_index - 1;

    void enter(Index node) {
        low_[node] = number_[node] = count_++;
        calls_.push_back({node, 0});
        open_.push_back(node);
    }
    void close(Index node) {
        const auto first = std::find(open_.begin(), open_.end(), node);
        found.emplace_back(first, open_.end());
        for (auto k = first; k != open_.end(); ++k) number_[*k] = done;
        open_.erase(first, open_.end());
    }

    const Successors& successors_;
    std::vector<Index> number_, low_;
    std::vector<Call> calls_;
    std::vector<Index> open_;
    Index count_ = 0;
};

}  // namespace

DepthLevels sort_by_levels(const Successors& successors) {
    DepthLevels levels;
    levels.component.resize(successors.size());
    levels.level.resize(successors.size());
    std::vector<Index> all(successors.size());
    std::iota(all.begin(), all.end(), Index{0});
    resort_by_levels(levels, successors, all);
    return levels;
}

std::size_t resort_by_levels(DepthLevels& levels, const Successors& successors,
                             std::span<const Index> heads) {
    Components components(successors);
    for (const Index head : heads) components.visit(head);
    std::size_t sorted = 0;
    std::vector<char> affected(successors.size(), 0);
    for (const auto& members : components.found) {
        const Index least = *std::min_element(members.begin(), members.end());
        for (const Index node : members) {
            levels.component[node] = least;
            levels.level[node] = 0;
            affected[node] = 1;
        }
        sorted += members.size();
    }
    const auto push = [&](Index from, Index to, std::vector<Index>& level) {
        if (levels.component[from] != levels.component[to]) level[to] = std::max(level[to], level[from] + 1);
    };
    // Ancestors that have not changed give their levels first.
    for (Index from = 0; from < successors.size(); ++from)
        if (affected[from] == 0)
            for (const Index to : successors[from])
                if (affected[to] != 0) push(from, to, levels.level);
    for (auto members = components.found.rbegin(); members != components.found.rend(); ++members) {
        Index highest = 0;
        for (const Index node : *members) highest = std::max(highest, levels.level[node]);
        for (const Index node : *members) levels.level[node] = highest;
        for (const Index node : *members)
            for (const Index to : successors[node]) push(node, to, levels.level);
    }
    return sorted;
}

std::vector<Index> front_to_back(const DepthLevels& levels) {
    std::vector<Index> order(levels.level.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
        return std::tuple(levels.level[a], levels.component[a], a) <
               std::tuple(levels.level[b], levels.component[b], b);
    });
    return order;
}

}  // namespace afterglow
