#include "solver/visibility/closed_body.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <vector>

namespace afterglow {

std::vector<Index> joined_positions(const Body& body) {
    const auto key = [&](Index v) {
        const Vec3& p = body.positions[v];
        return std::tuple(p.x, p.y, p.z);
    };
    std::vector<Index> order(body.positions.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
    std::vector<Index> number(order.size());
    Index next = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k > 0 && key(order[k]) != key(order[k - 1])) ++next;
        number[order[k]] = next;
    }
    return number;
}

namespace {

/// Edges as they run round the faces; each must run back again round another.
bool edges_run_both_ways(const std::vector<std::array<Index, 3>>& faces) {
    std::vector<std::array<Index, 2>> there, back;
    for (const auto& face : faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            there.push_back({face[k], face[(k + 1) % 3]});
            back.push_back({face[(k + 1) % 3], face[k]});
        }
    }
    std::sort(there.begin(), there.end());
    std::sort(back.begin(), back.end());
    return there == back;
}

/// The piece that each corner belongs to, named by one of its corners.
std::vector<Index> pieces_of(const std::vector<std::array<Index, 3>>& faces, std::size_t corners) {
    std::vector<Index> parent(corners);
    std::iota(parent.begin(), parent.end(), Index{0});
    const auto root = [&](Index v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const auto& face : faces)
        for (const Index v : {face[1], face[2]}) parent[root(v)] = root(face[0]);
    for (Index v = 0; v < parent.size(); ++v) parent[v] = root(v);
    return parent;
}

}  // namespace

bool is_closed_outwards(const Body& body) {
    const std::vector<Index> number = joined_positions(body);
    std::vector<std::array<Index, 3>> faces;
    for (const Triangle& t : body.triangles)
        faces.push_back({number[t.vertices[0]], number[t.vertices[1]], number[t.vertices[2]]});
    if (faces.empty() || !edges_run_both_ways(faces)) return false;
    const std::vector<Index> piece = pieces_of(faces, number.size());
    std::vector<double> volume(number.size(), 0);
    // Six times the signed volume, from the first corner so that far places lose no digits.
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto& v = body.triangles[f].vertices;
        const Vec3 origin = body.positions[body.triangles[0].vertices[0]];
        const Vec3 a = body.positions[v[0]] - origin, b = body.positions[v[1]] - origin,
                   c = body.positions[v[2]] - origin;
        volume[piece[faces[f][0]]] += static_cast<double>(glm::dot(a, glm::cross(b, c)));
    }
    return std::all_of(faces.begin(), faces.end(),
                       [&](const auto& face) { return volume[piece[face[0]]] > 0; });
}

}  // namespace afterglow
