#include "solver/image/picture_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace afterglow {

namespace {

// Of a pixel: far more than rounding moves a projected corner.
constexpr float slack_pixels = 0.05F;
// Metres before the camera, nearer than which nothing is projected.
constexpr float nearest_m = 1e-4F;

/// Bounds of what is projected, in pixels.
struct Bounds {
    float left, right, top, bottom;
};

/// First and last tile along one direction; empty where last < first.
std::pair<int, int> tiles_between(float low, float high, int count) {
    const auto edge = static_cast<float>(PictureTiles::edge);
    const float last = static_cast<float>(count - 1);
    return {static_cast<int>(std::clamp(std::floor((low - slack_pixels) / edge), 0.0F, last + 1)),
            static_cast<int>(std::clamp(std::floor((high + slack_pixels) / edge), -1.0F, last))};
}

/// Beyond this many pixels from the picture's corner, edges are too uncertain to leave a tile out by.
constexpr float farthest_pixels = 1e4F;

/// One edge of a projected triangle: which tiles lie wholly beyond it.
struct Edge {
    double across_x = 0, across_y = 0;  ///< unit, away from the triangle
    double reach = 0;                   ///< of the triangle along it

    Edge(const Vec3& from, const Vec3& to, const Vec3& opposite) {
        const double x = static_cast<double>(to.y) - from.y, y = static_cast<double>(from.x) - to.x;
        const double length = std::sqrt(x * x + y * y);
        if (!(length > 0)) return;
        const double inwards = x * (opposite.x - from.x) + y * (opposite.y - from.y);
        across_x = (inwards > 0 ? -x : x) / length;
        across_y = (inwards > 0 ? -y : y) / length;
        reach = across_x * from.x + across_y * from.y + slack_pixels;
    }
    [[nodiscard]] bool leaves_out(int column, int row) const {
        constexpr double edge = PictureTiles::edge;
        const double x = edge * (across_x > 0 ? column : column + 1);
        const double y = edge * (across_y > 0 ? row : row + 1);
        return across_x * x + across_y * y > reach;
    }
};

/// A projected triangle, told from its bounds where it is near enough.
class Outline {
  public:
    Outline(const Vec3& a, const Vec3& b, const Vec3& c)
        : edges_{Edge(a, b, c), Edge(b, c, a), Edge(c, a, b)} {
        for (const Vec3& corner : {a, b, c})
            if (!(std::abs(corner.x) < farthest_pixels && std::abs(corner.y) < farthest_pixels))
                is_certain_ = false;
    }
    [[nodiscard]] bool leaves_out(int column, int row) const {
        return is_certain_ && std::any_of(edges_.begin(), edges_.end(),
                                          [&](const Edge& edge) { return edge.leaves_out(column, row); });
    }

  private:
    std::array<Edge, 3> edges_;
    bool is_certain_ = true;
};

}  // namespace

std::vector<Index> tiles_covered(const CameraView& view, const PictureTiles& tiles, const Body& body,
                                 const Pose& pose) {
    const float pixel = 2 * view.half_height / static_cast<float>(view.height);
    std::vector<Vec3> projected;  // pixels, and the depth in metres
    for (const Vec3& position : body.positions) {
        const Vec3 at = pose.point(position) - view.position;
        const float depth = glm::dot(at, view.forward), scale = 1 / (pixel * depth);
        projected.emplace_back(0.5F * static_cast<float>(view.width) + scale * glm::dot(at, view.right),
                               0.5F * static_cast<float>(view.height) - scale * glm::dot(at, view.up), depth);
    }
    std::vector<char> touched(tiles.count(), 0);
    for (const Triangle& triangle : body.triangles) {
        const auto& v = triangle.vertices;
        const auto [a, b, c] = std::array{projected[v[0]], projected[v[1]], projected[v[2]]};
        const auto depths = std::minmax({a.z, b.z, c.z});
        if (depths.second < 0) continue;
        if (depths.first < nearest_m) {
            std::fill(touched.begin(), touched.end(), 1);
            break;
        }
        const auto [left, right] = std::minmax({a.x, b.x, c.x});
        const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
        const auto [first_column, last_column] = tiles_between(left, right, tiles.across);
        const auto [first_row, last_row] = tiles_between(top, bottom, tiles.down);
        const Outline outline(a, b, c);
        for (int row = first_row; row <= last_row; ++row)
            for (int column = first_column; column <= last_column; ++column)
                if (!outline.leaves_out(column, row))
                    touched[static_cast<std::size_t>(row) * static_cast<std::size_t>(tiles.across) +
                            static_cast<std::size_t>(column)] = 1;
    }
    std::vector<Index> covered;
    for (Index t = 0; t < touched.size(); ++t)
        if (touched[t] != 0) covered.push_back(t);
    return covered;
}

}  // namespace afterglow
