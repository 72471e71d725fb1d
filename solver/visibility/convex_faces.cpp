#include "solver/visibility/convex_faces.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "solver/visibility/closed_body.h"

namespace afterglow {

namespace {

// How far off a plane a corner may lie, as a share of the quadrangle's size: what rounding leaves.
constexpr float flat_share = 1e-6F;

// The sine of the least turn at a corner.
constexpr float least_turn = 1e-3F;

Vec3 corner_of(const Body& body, Index triangle, std::size_t k) {
    return body.positions[body.triangles[triangle].vertices[k % 3]];
}

ConvexFace triangle_face(const Body& body, Index t) {
    ConvexFace face;
    for (std::size_t k = 0; k < 3; ++k) face.corners[k] = corner_of(body, t, k);
    face.corners[3] = face.corners[0];
    face.count = 3;
    face.triangle = t;
    face.normal = glm::cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]);
    return face;
}

bool turns_outwards(const std::array<Vec3, 4>& corners, const Vec3& unit_normal) {
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 in = corners[k] - corners[(k + 3) % 4], out = corners[(k + 1) % 4] - corners[k];
        if (!(glm::dot(glm::cross(in, out), unit_normal) > least_turn * glm::length(in) * glm::length(out)))
            return false;
    }
    return true;
}

/// Triangle t and the one across its edge from corner k: the diagonal of what they make together.
std::optional<ConvexFace> joined(const Body& body, Index t, std::size_t k, Index other, std::size_t apex) {
    ConvexFace face = triangle_face(body, t);
    const ConvexFace beside = triangle_face(body, other);
    const float length = glm::length(face.normal);
    if (!(length > 0) || !(glm::dot(face.normal, beside.normal) > 0)) return std::nullopt;
    const Vec3 unit_normal = face.normal / length;
    const Vec3 far = corner_of(body, other, apex);
    face.corners = {corner_of(body, t, k + 1), corner_of(body, t, k + 2), corner_of(body, t, k), far};
    const float size =
        std::max(glm::distance(face.corners[0], face.corners[2]), glm::distance(face.corners[1], far));
    if (std::abs(glm::dot(far - face.corners[0], unit_normal)) > flat_share * size) return std::nullopt;
    if (!turns_outwards(face.corners, unit_normal)) return std::nullopt;
    face.count = 4;
    face.second_triangle = other;
    // The first triangle runs from corner 0 by 1 to 2: it lies on the right of the diagonal.
    face.to_second = glm::cross(unit_normal, face.corners[2] - face.corners[0]);
    return face;
}

}  // namespace

std::vector<ConvexFace> convex_faces(const Body& body) {
    const std::vector<Index> number = joined_positions(body);
    struct Owner {
        Index triangle;
        std::size_t edge;
    };
    // Who has an edge, by its ends as it runs round the triangle; the first of several.
    std::map<std::pair<Index, Index>, Owner> owners;
    const auto end = [&](Index t, std::size_t k) { return number[body.triangles[t].vertices[k % 3]]; };
    for (Index t = 0; t < body.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) owners.try_emplace({end(t, k), end(t, k + 1)}, Owner{t, k});

    std::vector<ConvexFace> faces;
    std::vector<char> taken(body.triangles.size(), 0);
    for (Index t = 0; t < body.triangles.size(); ++t) {
        if (taken[t] != 0) continue;
        std::optional<ConvexFace> face;
        for (std::size_t k = 0; k < 3 && !face; ++k) {
            const auto beside = owners.find({end(t, k + 1), end(t, k)});
            if (beside == owners.end()) continue;
            const auto [other, edge] = beside->second;
            if (other == t || taken[other] != 0) continue;
            face = joined(body, t, k, other, edge + 2);
            if (face) taken[other] = 1;
        }
        taken[t] = 1;
        faces.push_back(face ? *face : triangle_face(body, t));
    }
    return faces;
}

}  // namespace afterglow
