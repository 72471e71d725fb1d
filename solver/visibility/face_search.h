#pragma once

#include <vector>

#include "solver/visibility/line_tests.h"
#include "solver/visibility/temporal_bsp.h"

namespace afterglow {

/// The nearest that sixteen lines have met so far.
struct LaneHits {
    alignas(64) std::array<float, 16> distance;  ///< metres; at first how far the line reaches
    std::array<Index, 16> body, triangle;        ///< body no_index: nothing yet
    std::array<Side, 16> side;

    void start(const RayPacket& rays) {
        distance = rays.far;
        body.fill(no_index);
    }
};

/// A body whose faces lines are tested against.
struct SearchedBody {
    Index body = 0;
    Box box;                      ///< body frame
    std::vector<LineFace> faces;  ///< by triangle
    std::vector<Index> solid;     ///< triangles that have an area
    BspTree tree;
};
SearchedBody make_searched_body(const World& world, Index body);

/// What searching has cost.
struct SearchWork {
    std::uint64_t line_face_tests = 0;  ///< lines that still looked for something, times faces
    std::uint64_t node_visits = 0;      ///< nodes of trees that packets went through
};

// Each search tests `lanes` of lines given in the body's frame, writes hits nearer than what is already there
// and returns the lanes it found any for. Thread-safety: one thread an argument.

/// Object level: all faces in any order, the nearest hit counts.
std::uint32_t search_all(const SearchedBody& body, const RayPacket& rays, std::uint32_t lanes, LaneHits& hits,
                         SearchWork& work);

/// Surface level as the report has it: the faces in the viewpoint's order, each line ends at its first hit.
/// Within a run of the order the nearest hit counts.
std::uint32_t search_in_order(const SearchedBody& body, const TemporalBsp& temporal, const RayPacket& rays,
                              std::uint32_t lanes, LaneHits& hits, SearchWork& work);

/// Surface level by walking the tree: near side, own faces, far side, as the stored signs say, leaving out
/// subtrees whose boxes no line meets. Below a plane that the viewpoint's ball reaches across, the nearest
/// hit counts.
std::uint32_t search_tree(const SearchedBody& body, const TemporalBsp& temporal, const LinePacket& lines,
                          std::uint32_t lanes, LaneHits& hits, SearchWork& work);

}  // namespace afterglow
