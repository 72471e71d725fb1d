#include "solver/image/picture_tiles.h"

#include <algorithm>
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
        for (int row = first_row; row <= last_row; ++row)
            for (int column = first_column; column <= last_column; ++column)
                touched[static_cast<std::size_t>(row) * static_cast<std::size_t>(tiles.across) +
                        static_cast<std::size_t>(column)] = 1;
    }
    std::vector<Index> covered;
    for (Index t = 0; t < touched.size(); ++t)
        if (touched[t] != 0) covered.push_back(t);
    return covered;
}

}  // namespace afterglow
