#include "solver/formfactor/hemicube.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "solver/base/error.h"

namespace afterglow {

namespace {

constexpr int highest_resolution = 8192;
/// Pixels by which polygons are widened, so that no pixel centre falls between two that share an edge, even
/// where each has its own roundings of it in single precision. Those without item are narrowed instead: the
/// backs of a solid must not show along its outline.
constexpr double overlap = 1e-4;
/// Stands for them in a pixel.
constexpr Index without_item = no_index - 1;
/// A polygon whose plane passes the eye closer than this, for its size, is seen edge-on.
constexpr double edge_on = 1e-12;

/// Form factor of the rectangle [0, x] × [0, y] in the plane one above the eye.
double above(double x, double y) {
    const double a = std::sqrt(1 + x * x), b = std::sqrt(1 + y * y);
    return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2 * pi_d);
}

/// Form factor of the rectangle [0, y] × [0, z] in the upright plane one before the eye, z from the horizon.
double beside(double y, double z) {
    const double a = std::sqrt(1 + z * z);
    return (std::atan(y) - std::atan(y / a) / a) / (2 * pi_d);
}

/// Form factors of pixels as differences of a function of their corners; coordinates −1 … 1 by 2 / n.
std::vector<double> deltas(int columns, int rows, double first_row,
                           const std::function<double(double, double)>& corner) {
    const double step = 2.0 / columns;
    std::vector<double> out;
    out.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double x = step * column - 1, y = first_row + step * row;
            out.push_back(corner(x + step, y + step) - corner(x, y + step) - corner(x + step, y) +
                          corner(x, y));
        }
    return out;
}

/// One face: which of the eye's axes run along its columns and rows, and towards it.
struct Face {
    int across, up, towards;
    double sign;  ///< of the axis towards the face
    bool is_top;

    [[nodiscard]] Vec3d local(const Vec3d& v) const { return {v[across], v[up], sign * v[towards]}; }
};
constexpr std::array<Face, 5> faces{{{0, 1, 2, 1, true},
                                     {1, 2, 0, 1, false},
                                     {1, 2, 0, -1, false},
                                     {0, 2, 1, 1, false},
                                     {0, 2, 1, -1, false}}};

/// The pixels of one face while polygons are drawn into it.
class Canvas {
  public:
    Canvas(int resolution, double near_m)
        : resolution_(resolution),
          near_m_(near_m),
          nearness_(static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution)),
          item_(nearness_.size()) {}

    void begin(const Face& face) {
        face_ = face;
        rows_ = face.is_top ? resolution_ : resolution_ / 2;
        std::fill(nearness_.begin(), nearness_.end(), 0.0);
        std::fill(item_.begin(), item_.end(), no_index);
    }

    /// `corners` from the eye, in its axes.
    void draw(std::span<const Vec3d> corners, Index item) {
        shape_.clear();
        double extent = 0;
        for (const Vec3d& c : corners) {
            shape_.push_back(face_.local(c));
            extent = std::max(extent, glm::length(c));
        }
        const Vec3d normal = area_vector(shape_);
        const double distance = glm::dot(normal, shape_[0]);
        if (std::abs(distance) <= edge_on * glm::length(normal) * extent) return;
        if (!cut_to_pyramid()) return;
        overlap_ = item == no_index ? -overlap : overlap;
        // The nearness 1/z of the plane at (x, y, 1) is this vector's product with (x, y, 1).
        fill(normal / distance, item == no_index ? without_item : item);
    }

    void add_up(const std::vector<double>& delta, HemicubeView& view) const {
        for (std::size_t k = 0; k < delta.size(); ++k) {
            double& share = item_[k] == no_index       ? view.sky
                            : item_[k] == without_item ? view.hidden
                                                       : view.factor[item_[k]];
            share += delta[k];
        }
    }

  private:
    /// Whether anything is left. All planes but the near one pass the eye, so corners keep their distances.
    bool cut_to_pyramid() {
        const double root = std::sqrt(0.5);
        const std::array planes{
            Plane{{-root, 0, root}, 0}, Plane{{root, 0, root}, 0}, Plane{{0, -root, root}, 0},
            face_.is_top ? Plane{{0, root, root}, 0} : Plane{{0, 1, 0}, 0}, Plane{{0, 0, 1}, near_m_}};
        for (const Plane& plane : planes) {
            clip_to_front(shape_, plane, 0, cut_);
            std::swap(shape_, cut_);
            if (shape_.size() < 3) return false;
        }
        return true;
    }

    void fill(const Vec3d& plane, Index item) {
        const double half = 0.5 * resolution_, row_offset = face_.is_top ? half : 0;
        double low = resolution_, high = 0;
        for (Vec3d& c : shape_) {
            c = Vec3d(half * (c.x / c.z) + half, half * (c.y / c.z) + row_offset, 0);
            low = std::min(low, c.y);
            high = std::max(high, c.y);
        }
        const int first = first_pixel(low), last = last_pixel(high, rows_);
        for (int row = first; row <= last; ++row) {
            const double y = std::clamp(row + 0.5, low, high);
            const auto [left, right] = crossing(y);
            const double up = (row + 0.5 - row_offset) / half;
            const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(resolution_);
            const int last_column = last_pixel(right, resolution_);
            for (int column = first_pixel(left); column <= last_column; ++column) {
                const double nearness = plane.x * ((column + 0.5) / half - 1) + plane.y * up + plane.z;
                const std::size_t k = start + static_cast<std::size_t>(column);
                if (nearness <= nearness_[k]) continue;
                nearness_[k] = nearness;
                item_[k] = item;
            }
        }
    }

    /// The pixels whose centres lie within a range: the first and the last of them.
    [[nodiscard]] int first_pixel(double low) const {
        return std::max(0, static_cast<int>(std::ceil(low - 0.5 - overlap_)));
    }
    [[nodiscard]] int last_pixel(double high, int count) const {
        return std::min(count - 1, static_cast<int>(std::floor(high - 0.5 + overlap_)));
    }

    /// Where the line at `y` enters and leaves the convex shape, in pixels.
    [[nodiscard]] std::array<double, 2> crossing(double y) const {
        double left = resolution_, right = 0;
        for (std::size_t k = 0; k < shape_.size(); ++k) {
            const Vec3d& a = shape_[k];
            const Vec3d& b = shape_[k + 1 < shape_.size() ? k + 1 : 0];
            if ((a.y < y && b.y < y) || (a.y > y && b.y > y)) continue;
            const double share = a.y == b.y ? 0 : (y - a.y) / (b.y - a.y);
            const double x = a.x + share * (b.x - a.x);
            left = std::min({left, x, a.y == b.y ? b.x : x});
            right = std::max({right, x, a.y == b.y ? b.x : x});
        }
        return {left, right};
    }

    int resolution_, rows_ = 0;
    double near_m_, overlap_ = 0;
    Face face_{};
    std::vector<double> nearness_;  ///< 1 / distance along the face's axis, 0 where nothing is
    std::vector<Index> item_;
    std::vector<Vec3d> shape_, cut_;
};

/// All corners from the eye, in its axes.
std::vector<Vec3d> seen_from(const HemicubeEye& eye, std::span<const HemicubePolygon> polygons) {
    const Frame single{Vec3(eye.normal)};
    // The frame is made anew from the exact normal: single precision only chooses the turn about it.
    const Vec3d z = glm::normalize(eye.normal), x = glm::normalize(glm::cross(Vec3d(single.y), z));
    const Vec3d y = glm::cross(z, x);
    std::vector<Vec3d> out;
    for (const HemicubePolygon& polygon : polygons)
        for (const Vec3d& c : polygon.corners) {
            const Vec3d d = c - eye.point;
            out.emplace_back(glm::dot(d, x), glm::dot(d, y), glm::dot(d, z));
        }
    return out;
}

}  // namespace

Hemicube::Hemicube(const HemicubeConfig& config) : config_(config) {
    const int n = config.resolution;
    if (n < 2 || n > highest_resolution || n % 2 != 0)
        throw Error(ErrorKind::invalid_input, "hemicube resolution",
                    std::to_string(n) + " is not an even number from 2 to 8192");
    if (!(config.near_m > 0) || !std::isfinite(config.near_m))
        throw Error(ErrorKind::invalid_input, "hemicube near_m",
                    "the near plane is not at a distance above 0");
    top_ = deltas(n, n, -1, above);
    side_ = deltas(n, n / 2, 0, beside);
}

HemicubeView Hemicube::look(const HemicubeEye& eye, std::span<const HemicubePolygon> polygons,
                            std::size_t items) const {
    for (std::size_t p = 0; p < polygons.size(); ++p)
        if ((polygons[p].item >= items && polygons[p].item != no_index) || polygons[p].corners.size() < 3)
            throw Error(ErrorKind::invalid_input, "hemicube polygon " + std::to_string(p),
                        "it has an item out of range or fewer than three corners");
    const std::vector<Vec3d> corners = seen_from(eye, polygons);
    HemicubeView view{std::vector<double>(items, 0.0), 0, 0};
    Canvas canvas(config_.resolution, config_.near_m);
    for (const Face& face : faces) {
        canvas.begin(face);
        std::size_t first = 0;
        for (const HemicubePolygon& polygon : polygons) {
            canvas.draw(std::span(corners).subspan(first, polygon.corners.size()), polygon.item);
            first += polygon.corners.size();
        }
        canvas.add_up(face.is_top ? top_ : side_, view);
    }
    return view;
}

}  // namespace afterglow
