#include "solver/mesh/adjacency.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace afterglow {

namespace {

/// The same number for all vertices at one position.
std::vector<Index> weld(const std::vector<Vec3>& positions) {
    std::vector<Index> order(positions.size());
    std::iota(order.begin(), order.end(), Index{0});
    const auto key = [&](Index v) { return std::tuple(positions[v].x, positions[v].y, positions[v].z, v); };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
    std::vector<Index> same(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool again = i > 0 && positions[order[i]] == positions[order[i - 1]];
        same[order[i]] = again ? same[order[i - 1]] : order[i];
    }
    return same;
}

struct EdgeUse {
    Index low, high, triangle;
    auto operator<=>(const EdgeUse&) const = default;
};

}  // namespace

Adjacency find_adjacency(const Body& body) {
    const auto same = weld(body.positions);
    Adjacency out;
    out.welded.resize(body.triangles.size());
    std::vector<EdgeUse> uses;
    uses.reserve(3 * body.triangles.size());
    for (Index t = 0; t < body.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) out.welded[t][k] = same[body.triangles[t].vertices[k]];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(out.welded[t][k], out.welded[t][(k + 1) % 3]);
            uses.push_back({low, high, t});
        }
    }
    std::sort(uses.begin(), uses.end());

    std::vector<std::pair<Index, Index>> pairs;
    for (std::size_t first = 0; first < uses.size();) {
        std::size_t last = first;
        while (last < uses.size() && uses[last].low == uses[first].low && uses[last].high == uses[first].high)
            ++last;
        // Where three or more meet, something stands on the edge: light differs from one side to the other.
        if (last - first == 2) {
            pairs.emplace_back(uses[first].triangle, uses[first + 1].triangle);
            pairs.emplace_back(uses[first + 1].triangle, uses[first].triangle);
        }
        first = last;
    }
    std::sort(pairs.begin(), pairs.end());
    out.begin.assign(body.triangles.size() + 1, 0);
    for (const auto& [from, to] : pairs) {
        ++out.begin[from + 1];
        out.neighbour.push_back(to);
    }
    std::partial_sum(out.begin.begin(), out.begin.end(), out.begin.begin());
    return out;
}

}  // namespace afterglow
