#include "solver/visibility/bsp_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace afterglow {

namespace {

/// A face while the tree grows: what is left of a triangle, as a convex polygon.
struct Piece {
    Index triangle = 0;
    Plane plane;
    std::vector<Vec3d> corners;
    std::vector<BspTree::Split> splits;
};
using Pieces = std::vector<Piece>;

enum class Place { coplanar, front, back, across };

Place place_of(const Piece& piece, const Plane& plane, double tolerance) {
    double lowest = 0, highest = 0;
    for (const Vec3d& corner : piece.corners) {
        const double above = plane.above(corner);
        lowest = std::min(lowest, above);
        highest = std::max(highest, above);
    }
    if (lowest >= -tolerance) return highest <= tolerance ? Place::coplanar : Place::front;
    return highest <= tolerance ? Place::back : Place::across;
}

/// The part of a polygon on one side: `sign` 1 for the front, −1 for the back.
std::vector<Vec3d> clipped(const std::vector<Vec3d>& corners, const Plane& plane, double sign) {
    std::vector<Vec3d> out;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3d& from = corners[k];
        const Vec3d& to = corners[(k + 1) % corners.size()];
        const double a = sign * plane.above(from), b = sign * plane.above(to);
        if (a >= 0) out.push_back(from);
        if ((a > 0 && b < 0) || (a < 0 && b > 0)) out.push_back(from + (a / (a - b)) * (to - from));
    }
    return out;
}

/// How many pieces a plane would leave on each side, those across it counted on both.
struct Division {
    std::size_t front = 0, back = 0, across = 0;
};
Division division_by(const Plane& plane, const Pieces& pieces, double tolerance) {
    Division out;
    for (const Piece& piece : pieces) {
        const Place place = place_of(piece, plane, tolerance);
        out.front += place == Place::front || place == Place::across ? 1U : 0U;
        out.back += place == Place::back || place == Place::across ? 1U : 0U;
        out.across += place == Place::across ? 1U : 0U;
    }
    return out;
}

Vec3d middle_of(const Piece& piece) {
    const Vec3d sum = std::accumulate(piece.corners.begin(), piece.corners.end(), Vec3d(0));
    return sum / static_cast<double>(piece.corners.size());
}

/// The plane across the longest extent of the pieces' middles, through the middle in the middle.
Plane free_plane(const Pieces& pieces) {
    std::vector<Vec3d> middles;
    Vec3d low(std::numeric_limits<double>::infinity()), high = -low;
    for (const Piece& piece : pieces) {
        middles.push_back(middle_of(piece));
        low = glm::min(low, middles.back());
        high = glm::max(high, middles.back());
    }
    const Vec3d extent = high - low;
    int axis = extent.x >= extent.y ? 0 : 1;
    if (extent.z > extent[axis]) axis = 2;
    const auto median = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
    std::nth_element(middles.begin(), median, middles.end(),
                     [axis](const Vec3d& a, const Vec3d& b) { return a[axis] < b[axis]; });
    Plane plane{Vec3d(0), (*median)[axis]};
    plane.normal[axis] = 1;
    return plane;
}

class Builder {
  public:
    Builder(const BspConfig& config, double tolerance, std::size_t most_faces)
        : config_(config), tolerance_(tolerance), box_slack_(10 * tolerance), most_faces_(most_faces) {}

    /// Appends the tree of the pieces and returns its root.
    Index add(Pieces pieces, int depth) {
        const auto index = static_cast<Index>(tree_.nodes.size());
        tree_.nodes.emplace_back();
        const Plane plane = choose(pieces);
        tree_.nodes[index].plane = plane;
        tree_.nodes[index].first_face = static_cast<Index>(tree_.faces.size());
        for (const Piece& piece : pieces)
            for (const Vec3d& corner : piece.corners)
                for (const double slack : {-box_slack_, box_slack_})
                    tree_.nodes[index].box.add(Vec3(corner + Vec3d(slack)));

        Pieces own, front, back;
        if (depth >= config_.most_depth || tree_.faces.size() + pieces.size() > most_faces_)
            own = std::move(pieces);
        else
            divide(std::move(pieces), index, own, front, back);
        for (const Piece& piece : own) append(piece);
        tree_.nodes[index].own_faces = static_cast<Index>(own.size());
        if (!front.empty()) {
            const Index child = add(std::move(front), depth + 1);
            tree_.nodes[index].front = child;
        }
        if (!back.empty()) {
            const Index child = add(std::move(back), depth + 1);
            tree_.nodes[index].back = child;
        }
        tree_.nodes[index].subtree_faces =
            static_cast<Index>(tree_.faces.size()) - tree_.nodes[index].first_face;
        return index;
    }
    BspTree take() { return std::move(tree_); }

  private:
    [[nodiscard]] Plane choose(const Pieces& pieces) const {
        if (pieces.size() > config_.free_plane_faces) {
            const Plane plane = free_plane(pieces);
            const Division division = division_by(plane, pieces, tolerance_);
            // Worth it only where it comes near to halving.
            if (4 * std::max(division.front, division.back) <= 3 * pieces.size()) return plane;
        }
        const std::size_t tried = std::min(config_.candidates, pieces.size());
        Plane best = pieces.front().plane;
        std::size_t least = std::numeric_limits<std::size_t>::max();
        for (std::size_t k = 0; k < tried; ++k) {
            const Plane& plane = pieces[k * pieces.size() / tried].plane;
            const Division division = division_by(plane, pieces, tolerance_);
            const std::size_t cost = 8 * division.across + std::max(division.front, division.back) -
                                     std::min(division.front, division.back);
            if (cost >= least) continue;
            least = cost;
            best = plane;
        }
        return best;
    }

    void divide(Pieces pieces, Index node, Pieces& own, Pieces& front, Pieces& back) const {
        const Plane plane = tree_.nodes[node].plane;
        for (Piece& piece : pieces) {
            switch (place_of(piece, plane, tolerance_)) {
                case Place::coplanar:
                    own.push_back(std::move(piece));
                    break;
                case Place::front:
                    front.push_back(std::move(piece));
                    break;
                case Place::back:
                    back.push_back(std::move(piece));
                    break;
                case Place::across: {
                    Piece behind = piece;
                    behind.corners = clipped(piece.corners, plane, -1);
                    behind.splits.push_back({node, false});
                    piece.corners = clipped(piece.corners, plane, 1);
                    piece.splits.push_back({node, true});
                    front.push_back(std::move(piece));
                    back.push_back(std::move(behind));
                    break;
                }
            }
        }
    }

    void append(const Piece& piece) {
        tree_.faces.push_back({piece.triangle, static_cast<Index>(tree_.split_list.size()),
                               static_cast<Index>(piece.splits.size())});
        tree_.split_list.insert(tree_.split_list.end(), piece.splits.begin(), piece.splits.end());
    }

    BspConfig config_;
    double tolerance_;
    double box_slack_;  // lines are tested in single precision: none may slip between two boxes
    std::size_t most_faces_;
    BspTree tree_;
};

}  // namespace

bool BspTree::holds(const Face& face, const Vec3d& point) const {
    for (Index k = face.first_split; k < face.first_split + face.splits; ++k)
        if ((nodes[split_list[k].node].plane.above(point) >= 0) != split_list[k].in_front) return false;
    return true;
}

BspTree make_bsp_tree(const Body& body, std::span<const Index> triangles, const BspConfig& config) {
    Pieces pieces;
    Box box;
    for (const Index t : triangles) {
        Piece piece{t, {}, {}, {}};
        for (const Index vertex : body.triangles[t].vertices) {
            piece.corners.emplace_back(body.positions[vertex]);
            box.add(body.positions[vertex]);
        }
        const Vec3d normal =
            glm::cross(piece.corners[1] - piece.corners[0], piece.corners[2] - piece.corners[0]);
        const double length = glm::length(normal);
        // A triangle without area has no plane and stops no line.
        if (!(length > 0)) continue;
        piece.plane.normal = normal / length;
        piece.plane.offset = glm::dot(piece.plane.normal, middle_of(piece));
        pieces.push_back(std::move(piece));
    }
    if (pieces.empty()) return {};
    const std::size_t most_faces = config.most_growth * pieces.size() + 64;
    Builder builder(config, config.coplanar_share * glm::length(Vec3d(box.extent())), most_faces);
    builder.add(std::move(pieces), 0);
    return builder.take();
}

BspTree make_bsp_tree(const Body& body, const BspConfig& config) {
    std::vector<Index> all(body.triangles.size());
    std::iota(all.begin(), all.end(), Index{0});
    return make_bsp_tree(body, all, config);
}

}  // namespace afterglow
