#pragma once

#include <span>
#include <vector>

#include "solver/scene/world.h"

namespace afterglow {

using Vec3d = glm::dvec3;

/// A plane: points p with dot(normal, p) = offset, in metres; the normal is unit and points to the front.
struct Plane {
    Vec3d normal{0, 0, 1};
    double offset = 0;

    [[nodiscard]] double above(const Vec3d& p) const { return glm::dot(normal, p) - offset; }
};

/// A binary space partition of some triangles of a body, in the body's frame. Nothing in it depends on who
/// looks. Faces are triangles, or parts of triangles that planes have split; a subtree's faces stand
/// together: the node's own first, then those of its front, then those of its back.
struct BspTree {
    struct Node {
        Plane plane;
        Index front = no_index, back = no_index;  ///< nodes; children stand after their parents
        Index first_face = 0;
        Index own_faces = 0;      ///< in the node's plane (or in no order: see BspConfig::most_depth)
        Index subtree_faces = 0;  ///< own ones, front and back
        Box box;                  ///< of the subtree's faces and a little more
    };
    /// A plane that has split a face, and the side of it that the face is on.
    struct Split {
        Index node = 0;
        bool in_front = false;
    };
    struct Face {
        Index triangle = 0;  ///< of the body
        Index first_split = 0, splits = 0;
    };
    std::vector<Node> nodes;  ///< the root is node 0; empty without faces
    std::vector<Face> faces;
    std::vector<Split> split_list;

    /// Whether a point of a face's triangle belongs to the face: exactly one part of a split triangle has it,
    /// however the point is rounded, so that lines cannot slip between the parts.
    [[nodiscard]] bool holds(const Face& face, const Vec3d& point) const;
};

struct BspConfig {
    /// Faces within this share of the body's diagonal of a plane lie in it.
    double coplanar_share = 1e-6;
    /// Sets larger than this may also be divided by a plane across their longest extent in which no face
    /// lies: of a convex body every face's plane has all others behind it, and the tree would be a chain.
    std::size_t free_plane_faces = 24;
    /// Face planes tried at a node; the one that splits least, then divides most evenly, is taken.
    std::size_t candidates = 8;
    /// What would stand deeper is kept in one node without order.
    int most_depth = 400;
    /// So is what would split the faces into more than this many times their number.
    std::size_t most_growth = 12;
};

/// Divides triangles of a body; those without area are left out. Autopartition: planes are those of faces,
/// see BspConfig::free_plane_faces. Deterministic. Cost: O(n log n) for bodies of few splits.
/// Source: Fuchs, Kedem and Naylor 1980; the report's section 3. Thread-safety: pure.
BspTree make_bsp_tree(const Body& body, std::span<const Index> triangles, const BspConfig& config = {});

/// Of all triangles of the body.
BspTree make_bsp_tree(const Body& body, const BspConfig& config = {});

}  // namespace afterglow
