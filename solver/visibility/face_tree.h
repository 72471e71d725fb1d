#pragma once

#include <vector>

#include "solver/visibility/convex_faces.h"

namespace afterglow {

/// A tree of boxes over the convex faces of one body, in the body's frame: what asks which faces something
/// passes need look at a few only. Thread-safety: const use is pure.
struct FaceTree {
    struct Node {
        Vec3 centre{0}, half{0};  ///< of the box, which is a little larger than need be
        Index first = 0;          ///< of its faces if it is a leaf, else of its two children
        Index count = 0;          ///< faces of a leaf; 0: not a leaf
    };
    std::vector<Node> nodes;        ///< the root first; empty for a body without triangles
    bool closed = false;            ///< see is_closed_outwards
    std::vector<ConvexFace> faces;  ///< those of a leaf together
};

/// Builds it by halving at the median along the longest axis of the centres. Thread-safety: pure.
FaceTree make_face_tree(const Body& body);

}  // namespace afterglow
