#include "solver/image/item_buffer.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace afterglow {

namespace {

using Vec3d = glm::dvec3;

/// Corners nearer to the camera's plane than this are not projected, metres.
constexpr double least_depth = 1e-4;

/// Pixels [left, right) × [top, bottom).
struct Window {
    int left, right, top, bottom;
};

/// A view in double precision; picture coordinates across and upwards are tangents.
struct Projection {
    Vec3d position, right, up, forward;
    double pixel, half_width, half_height;
    int width, height;

    explicit Projection(const CameraView& view)
        : position(view.position),
          right(view.right),
          up(view.up),
          forward(view.forward),
          pixel(2.0 * view.half_height / view.height),
          half_width(0.5 * view.width),
          half_height(0.5 * view.height),
          width(view.width),
          height(view.height) {}

    /// Through a pixel's centre; its length along `forward` is 1.
    [[nodiscard]] Vec3d direction(int x, int y) const {
        return forward + (x + 0.5 - half_width) * pixel * right + (half_height - y - 0.5) * pixel * up;
    }

    /// All pixels whose centres a triangle can cover; corners relative to the position.
    [[nodiscard]] Window window(const std::array<Vec3d, 3>& corners) const {
        double left = width, last_x = -1, top = height, last_y = -1;
        for (const Vec3d& corner : corners) {
            const double depth = glm::dot(corner, forward);
            // One that reaches behind the camera may cover anything.
            if (depth < least_depth) return {0, width, 0, height};
            const double x = glm::dot(corner, right) / (depth * pixel) + half_width;
            const double y = half_height - glm::dot(corner, up) / (depth * pixel);
            left = std::min(left, x);
            last_x = std::max(last_x, x);
            top = std::min(top, y);
            last_y = std::max(last_y, y);
        }
        const auto limited = [](double value, int most) {
            return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(most)));
        };
        return {limited(std::floor(left) - 1, width), limited(std::ceil(last_x) + 1, width),
                limited(std::floor(top) - 1, height), limited(std::ceil(last_y) + 1, height)};
    }
};

void draw_one(const Projection& view, const PlacedTriangle& triangle, Index index, ItemBuffer& out) {
    const Vec3d a = Vec3d(triangle.a) - view.position, b = Vec3d(triangle.b) - view.position,
                c = Vec3d(triangle.c) - view.position;
    // Whether a direction passes an edge on the inner side is linear in the direction.
    const std::array<Vec3d, 3> edges{glm::cross(a, b), glm::cross(b, c), glm::cross(c, a)};
    const Vec3d normal = glm::cross(b - a, c - a);
    const double height = glm::dot(normal, a);
    const Window window = view.window({a, b, c});
    for (int y = window.top; y < window.bottom; ++y) {
        for (int x = window.left; x < window.right; ++x) {
            const Vec3d direction = view.direction(x, y);
            const double e0 = glm::dot(direction, edges[0]), e1 = glm::dot(direction, edges[1]),
                         e2 = glm::dot(direction, edges[2]);
            const bool inside = std::min({e0, e1, e2}) >= 0 || std::max({e0, e1, e2}) <= 0;
            const double towards = glm::dot(normal, direction);
            if (!inside || towards == 0) continue;
            const double depth = height / towards;
            const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                                   static_cast<std::size_t>(x);
            if (depth <= 0 || depth >= out.depth[at]) continue;
            out.depth[at] = depth;
            out.item[at] = index;
            ++out.interpolations;
        }
    }
}

}  // namespace

ItemBuffer draw(const CameraView& view, std::span<const PlacedTriangle> triangles) {
    ItemBuffer out;
    out.width = view.width;
    out.height = view.height;
    const std::size_t pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    out.item.assign(pixels, no_index);
    out.depth.assign(pixels, std::numeric_limits<double>::infinity());
    const Projection projection(view);
    for (Index k = 0; k < triangles.size(); ++k) draw_one(projection, triangles[k], k, out);
    return out;
}

}  // namespace afterglow
